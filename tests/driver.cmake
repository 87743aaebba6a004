# The driver: its parts as a library, and the executable as a user runs it.
drumhead_test(NAME driver_test
  SOURCES driver_scratch.cpp driver_svg_test.cpp driver_scene_test.cpp driver_image_test.cpp
    driver_atomic_file_test.cpp driver_command_test.cpp driver_masks_test.cpp driver_maps_test.cpp
    driver_lattice_files_test.cpp
  LINK drumhead_driver
  LABEL unit)
drumhead_test(NAME driver_warp_test
  SOURCES driver_scratch.cpp driver_warp_test.cpp
  LINK drumhead_driver
  LABEL numeric)
foreach(test driver_test driver_warp_test)
  target_compile_definitions(${test} PRIVATE
    DRUMHEAD_EXECUTABLE="$<TARGET_FILE:drumhead>"
    DRUMHEAD_TEST_DATA="${CMAKE_CURRENT_LIST_DIR}/data")
  add_dependencies(${test} drumhead)
endforeach()
