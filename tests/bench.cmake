# The program that makes tables and the page of what the benchmarks leave.
drumhead_test(NAME bench_report_test SOURCES bench_report_test.cpp LINK LABEL unit)
target_compile_definitions(bench_report_test PRIVATE DRUMHEAD_REPORT="$<TARGET_FILE:report>")
add_dependencies(bench_report_test report)
add_test(NAME bench_report.names_what_fails_and_makes_the_rest
  COMMAND sh ${CMAKE_CURRENT_SOURCE_DIR}/bench_report_script.sh ${PROJECT_SOURCE_DIR}
    $<TARGET_FILE:report>)
set_tests_properties(bench_report.names_what_fails_and_makes_the_rest PROPERTIES LABELS unit)
