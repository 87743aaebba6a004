# The assembled oracle, its own tests, and the tests of the whole solver against it.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)

add_library(drumhead_oracle STATIC
  support/scenes.cpp support/oracle_cut.cpp support/oracle_system.cpp support/oracle_newton.cpp
  support/oracle_relax.cpp)
target_include_directories(drumhead_oracle PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
drumhead_compile_settings(drumhead_oracle)
# Eigen's sparse factorisation is many times slower without the optimiser; assertions stay on in debug.
target_compile_options(drumhead_oracle PRIVATE -O2)
target_link_libraries(drumhead_oracle PUBLIC Eigen3::Eigen)

foreach(name system cut)
  drumhead_test(NAME oracle_${name}_test SOURCES oracle_${name}_test.cpp LINK drumhead_oracle LABEL unit)
endforeach()
drumhead_test(NAME oracle_energy_test SOURCES oracle_energy_test.cpp LINK drumhead_oracle LABEL numeric)

# multigrid for its headers: the scenes are built as problems of the solver.
drumhead_test(NAME oracle_grid_cut_test
  SOURCES oracle_grid_cut_test.cpp support/scene_problem.cpp
  LINK drumhead_oracle drumhead::grid drumhead::multigrid LABEL unit)

# The same for conforming cells, whose geometry is the library's own.
add_library(drumhead_conforming_oracle STATIC
  support/oracle_conforming.cpp support/oracle_conforming_newton.cpp support/scene_problem.cpp)
drumhead_compile_settings(drumhead_conforming_oracle)
target_compile_options(drumhead_conforming_oracle PRIVATE -O2)
target_link_libraries(drumhead_conforming_oracle
  PUBLIC drumhead_oracle drumhead::grid drumhead::multigrid)
drumhead_test(NAME oracle_conforming_test
  SOURCES oracle_conforming_test.cpp LINK drumhead_conforming_oracle LABEL numeric)

foreach(name conforming_report exact default masks nested restart)
  drumhead_test(NAME stability_${name}_test
    SOURCES stability_${name}_test.cpp support/scene_problem.cpp
    LINK drumhead_oracle drumhead::multigrid LABEL numeric)
endforeach()
foreach(name cases conforming_cases degenerate stiff)
  drumhead_test(NAME stability_${name}_test
    SOURCES stability_${name}_test.cpp support/hard_cases.cpp support/scene_problem.cpp
    LINK drumhead_oracle drumhead::multigrid LABEL numeric)
endforeach()
drumhead_test(NAME stability_random_test
  SOURCES stability_random_test.cpp LINK drumhead::multigrid LABEL numeric)
drumhead_test(NAME stability_memory_test
  SOURCES stability_memory_test.cpp LINK drumhead::multigrid LABEL numeric)
drumhead_test(NAME stability_conforming_test
  SOURCES stability_conforming_test.cpp LINK drumhead_conforming_oracle LABEL numeric)

drumhead_test(NAME multigrid_warp_test
  SOURCES multigrid_warp_test.cpp support/scene_problem.cpp
  LINK drumhead_oracle drumhead::multigrid LABEL numeric)

add_library(drumhead_conforming_solid_oracle STATIC
  support/oracle_conforming_solid.cpp support/oracle_membrane.cpp)
drumhead_compile_settings(drumhead_conforming_solid_oracle)
target_compile_options(drumhead_conforming_solid_oracle PRIVATE -O2)
target_link_libraries(drumhead_conforming_solid_oracle PUBLIC drumhead_conforming_oracle)
drumhead_test(NAME multigrid_conforming_membranes_test
  SOURCES multigrid_conforming_membranes_test.cpp
  LINK drumhead_conforming_solid_oracle LABEL unit)
target_include_directories(multigrid_conforming_membranes_test
  PRIVATE ${PROJECT_SOURCE_DIR}/multigrid)
drumhead_test(NAME stability_conforming_membranes_test
  SOURCES stability_conforming_membranes_test.cpp
  LINK drumhead_conforming_solid_oracle LABEL numeric)

# It looks inside: the cycle is not part of the public headers.
drumhead_test(NAME multigrid_allocation_test
  SOURCES multigrid_allocation_test.cpp support/scene_problem.cpp
  LINK drumhead_oracle drumhead::multigrid LABEL unit)
target_include_directories(multigrid_allocation_test PRIVATE ${PROJECT_SOURCE_DIR}/multigrid)
drumhead_test(NAME multigrid_kept_levels_test
  SOURCES multigrid_kept_levels_test.cpp LINK drumhead::multigrid LABEL numeric)
target_include_directories(multigrid_kept_levels_test PRIVATE ${PROJECT_SOURCE_DIR}/multigrid)
# The linear solvers alone are not public.
drumhead_test(NAME multigrid_solvers_test
  SOURCES multigrid_solvers_test.cpp support/scene_problem.cpp
  LINK drumhead_oracle drumhead::multigrid LABEL numeric)
target_include_directories(multigrid_solvers_test PRIVATE ${PROJECT_SOURCE_DIR}/multigrid)

drumhead_test(NAME stability_membranes_test
  SOURCES stability_membranes_test.cpp support/oracle_membrane.cpp support/scene_problem.cpp
  LINK drumhead_oracle drumhead::multigrid LABEL numeric)

# What bench/ compares the membrane with.
drumhead_test(NAME bench_point_warps_test
  SOURCES bench_point_warps_test.cpp ${PROJECT_SOURCE_DIR}/bench/point_warps.cpp
  LINK drumhead::grid Eigen3::Eigen LABEL unit)
