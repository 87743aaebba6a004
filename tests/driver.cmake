# The driver: its parts as a library, and the executable as a user runs it.
drumhead_test(NAME driver_test
  SOURCES driver_scratch.cpp driver_svg_test.cpp driver_scene_test.cpp driver_image_test.cpp
    driver_atomic_file_test.cpp driver_command_test.cpp driver_masks_test.cpp driver_maps_test.cpp
    driver_lattice_files_test.cpp
    driver_pictures_test.cpp driver_plate_test.cpp
  LINK drumhead_driver
  LABEL unit)
drumhead_test(NAME driver_warp_test
  SOURCES driver_scratch.cpp driver_warp_test.cpp
  LINK drumhead_driver
  LABEL numeric)
drumhead_test(NAME driver_start_test
  SOURCES driver_scratch.cpp driver_start_test.cpp
  LINK drumhead_driver
  LABEL numeric)
drumhead_test(NAME driver_page_test
  SOURCES driver_scratch.cpp driver_page_test.cpp
  LINK drumhead_driver
  LABEL numeric)
drumhead_test(NAME driver_large_test
  SOURCES driver_scratch.cpp driver_large_test.cpp
  LINK drumhead_driver
  LABEL slow)
drumhead_test(NAME driver_examples_test
  SOURCES driver_scratch.cpp driver_examples_test.cpp
  LINK drumhead_driver
  LABEL slow)
drumhead_test(NAME driver_consumers_test
  SOURCES driver_scratch.cpp driver_consumers_test.cpp
  LINK drumhead_driver
  LABEL numeric)
# Two of OpenCV's libraries suffice, which its CMake package cannot find alone.
find_path(OPENCV_INCLUDE_DIR opencv2/imgproc.hpp PATH_SUFFIXES opencv4)
find_library(OPENCV_IMGPROC opencv_imgproc)
find_library(OPENCV_CORE opencv_core)
if(OPENCV_INCLUDE_DIR AND OPENCV_IMGPROC AND OPENCV_CORE)
  target_include_directories(driver_consumers_test SYSTEM PRIVATE ${OPENCV_INCLUDE_DIR})
  target_link_libraries(driver_consumers_test PRIVATE ${OPENCV_IMGPROC} ${OPENCV_CORE})
  target_compile_definitions(driver_consumers_test PRIVATE DRUMHEAD_TEST_OPENCV=1)
endif()
foreach(test driver_test driver_warp_test driver_start_test driver_page_test driver_large_test
    driver_examples_test driver_consumers_test)
  target_compile_definitions(${test} PRIVATE
    DRUMHEAD_EXECUTABLE="$<TARGET_FILE:drumhead>"
    DRUMHEAD_TEST_DATA="${CMAKE_CURRENT_LIST_DIR}/data")
  add_dependencies(${test} drumhead)
endforeach()
