# The kernels and the lattice's data: against the assembled oracle, against themselves on every
# instruction set and number of threads, and by properties.
add_library(drumhead_fields STATIC support/random_fields.cpp)
target_include_directories(drumhead_fields PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
drumhead_compile_settings(drumhead_fields)
target_link_libraries(drumhead_fields PUBLIC drumhead::kernels)

add_library(drumhead_kernel_oracle STATIC
  support/kernel_oracle.cpp support/oracle_kaczmarz.cpp)
drumhead_compile_settings(drumhead_kernel_oracle)
# Sparse products of Eigen are many times slower without the optimiser; assertions stay on in debug.
target_compile_options(drumhead_kernel_oracle PRIVATE -O2)
target_link_libraries(drumhead_kernel_oracle PUBLIC drumhead_fields drumhead_oracle)

foreach(name cuts elastic kaczmarz relax)
  drumhead_test(NAME kernels_${name}_test SOURCES kernels_${name}_test.cpp
    LINK drumhead_kernel_oracle LABEL unit)
endforeach()
foreach(name coarse_membranes membranes)
  drumhead_test(NAME kernels_${name}_test
    SOURCES kernels_${name}_test.cpp support/oracle_membrane.cpp
    LINK drumhead_kernel_oracle LABEL unit)
endforeach()
foreach(name band folds fused isa properties reduce threads transfer)
  drumhead_test(NAME kernels_${name}_test SOURCES kernels_${name}_test.cpp
    LINK drumhead_fields LABEL unit)
endforeach()
foreach(name coarsen conforming conforming_rules curve cut_cells edited_curves field lattice mask material)
  drumhead_test(NAME grid_${name}_test SOURCES grid_${name}_test.cpp
    LINK drumhead::grid LABEL unit)
endforeach()

drumhead_test(NAME grid_made_of_curves_test SOURCES grid_made_of_curves_test.cpp
  LINK drumhead::grid LABEL unit)
target_include_directories(grid_made_of_curves_test PRIVATE ${PROJECT_SOURCE_DIR}/grid)

drumhead_test(NAME multigrid_split_test SOURCES multigrid_split_test.cpp
  LINK drumhead::multigrid LABEL unit)
target_include_directories(multigrid_split_test PRIVATE ${PROJECT_SOURCE_DIR}/multigrid)
drumhead_test(NAME multigrid_curve_patch_test SOURCES multigrid_curve_patch_test.cpp
  LINK drumhead_kernel_oracle drumhead::multigrid LABEL unit)
target_include_directories(multigrid_curve_patch_test PRIVATE ${PROJECT_SOURCE_DIR}/multigrid)
# The private headers of multigrid/, whose levels make special cells for the kernels.
foreach(name conforming conforming_cycle conforming_relaxation curve_strip judge regions)
  drumhead_test(NAME multigrid_${name}_test
    SOURCES multigrid_${name}_test.cpp support/scene_problem.cpp
    LINK drumhead_oracle drumhead::multigrid LABEL unit)
  target_include_directories(multigrid_${name}_test PRIVATE ${PROJECT_SOURCE_DIR}/multigrid)
endforeach()
