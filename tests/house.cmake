# What no single program tests: the source tree, the symbols of the libraries, the installed package.
function(house_test name label)
  add_test(NAME ${name} COMMAND ${ARGN})
  set_tests_properties(${name} PROPERTIES
    LABELS ${label} TIMEOUT 1200 ENVIRONMENT OMP_WAIT_POLICY=passive)
endfunction()

set(house sh ${CMAKE_CURRENT_SOURCE_DIR}/house.sh)
house_test(house.files_are_short_and_licensed unit ${house} files)
house_test(house.functions_are_short unit ${house} functions)
house_test(house.no_arrow_points_backwards unit ${house} arrows)
house_test(house.readme_names_what_exists unit ${house} readme)
house_test(house.no_library_holds_a_sparse_matrix unit ${house} sparse
  $<TARGET_FILE:drumhead_kernels> $<TARGET_FILE:drumhead_grid> $<TARGET_FILE:drumhead_multigrid>)
set(prefix ${CMAKE_CURRENT_BINARY_DIR}/prefix)
house_test(package.installs unit
  ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${prefix})
set_tests_properties(package.installs PROPERTIES FIXTURES_SETUP package)

# The consumer, built with this build's compiler and flags (a sanitizer must be in both), and tested.
function(consumer_test name label)
  house_test(package.${name} ${label}
    ${CMAKE_CTEST_COMMAND}
    --build-and-test ${CMAKE_CURRENT_SOURCE_DIR}/consumer ${CMAKE_CURRENT_BINARY_DIR}/${name}
    --build-generator ${CMAKE_GENERATOR}
    --build-options
      -DCMAKE_BUILD_TYPE=${CMAKE_BUILD_TYPE}
      -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER}
      -DCMAKE_CXX_FLAGS=${CMAKE_CXX_FLAGS}
      ${ARGN}
    --test-command ${CMAKE_CTEST_COMMAND} --output-on-failure)
endfunction()
consumer_test(serves_an_installed_consumer unit
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON)
set_tests_properties(package.serves_an_installed_consumer PROPERTIES FIXTURES_REQUIRED package)

# Without optimisation nothing is inlined, and a sanitizer adds symbols and doubles the second build.
if(CMAKE_BUILD_TYPE STREQUAL "Release")
  house_test(house.each_instruction_set_keeps_to_its_namespace unit ${house} instruction_sets
    $<TARGET_FILE:drumhead_kernels>)
  consumer_test(serves_as_a_subproject numeric -DDRUMHEAD_TREE=${PROJECT_SOURCE_DIR})
endif()
