# The program that makes tables and the page of what the benchmarks leave.
drumhead_test(NAME bench_report_test SOURCES bench_report_test.cpp LINK LABEL unit)
target_compile_definitions(bench_report_test PRIVATE DRUMHEAD_REPORT="$<TARGET_FILE:report>")
add_dependencies(bench_report_test report)
