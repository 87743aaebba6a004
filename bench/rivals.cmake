# What else solves the same scenes, where its Debian package is there (bench/report.sh installs it).

# Warps from pairs of points; OpenCV's thin-plate spline with libopencv-shape-dev.
add_library(drumhead_warp_rivals STATIC point_warps.cpp warp_rivals.cpp)
drumhead_compile_settings(drumhead_warp_rivals)
target_link_libraries(drumhead_warp_rivals PUBLIC drumhead_nested_newton)
find_path(OPENCV_SHAPE_INCLUDE_DIR opencv2/shape/shape_transformer.hpp PATH_SUFFIXES opencv4)
find_library(OPENCV_SHAPE opencv_shape)
find_library(OPENCV_CORE opencv_core)
if(OPENCV_SHAPE_INCLUDE_DIR AND OPENCV_SHAPE AND OPENCV_CORE)
  target_include_directories(drumhead_warp_rivals SYSTEM PRIVATE ${OPENCV_SHAPE_INCLUDE_DIR})
  target_link_libraries(drumhead_warp_rivals PRIVATE ${OPENCV_SHAPE} ${OPENCV_CORE})
  target_compile_definitions(drumhead_warp_rivals PRIVATE DRUMHEAD_BENCH_OPENCV_SHAPE=1)
endif()
add_executable(warps_bench warps_bench.cpp)
drumhead_compile_settings(warps_bench)
target_link_libraries(warps_bench PRIVATE drumhead_warp_rivals)
# Pictures by them, where the driver is built too.
if(TARGET drumhead_driver)
  add_executable(warp_pictures warp_pictures.cpp)
  drumhead_compile_settings(warp_pictures)
  target_link_libraries(warp_pictures PRIVATE drumhead_warp_rivals drumhead_driver)
endif()

# A triangle mesh along the curves: CGAL (libcgal-dev) and CHOLMOD (libsuitesparse-dev).
find_path(CGAL_INCLUDE_DIR CGAL/Delaunay_mesher_2.h)
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
find_library(GMP_LIBRARY gmp)
find_library(MPFR_LIBRARY mpfr)
if(CGAL_INCLUDE_DIR AND CHOLMOD_INCLUDE_DIR AND CHOLMOD_LIBRARY AND GMP_LIBRARY AND MPFR_LIBRARY)
  add_executable(mesh_bench mesh_bench.cpp mesh_membrane.cpp curve_mesh.cpp)
  drumhead_compile_settings(mesh_bench)
  target_include_directories(mesh_bench SYSTEM PRIVATE ${CGAL_INCLUDE_DIR} ${CHOLMOD_INCLUDE_DIR})
  target_link_libraries(mesh_bench PRIVATE drumhead_nested_newton drumhead_bench_truth
    ${CHOLMOD_LIBRARY} ${GMP_LIBRARY} ${MPFR_LIBRARY})
endif()

# Algebraic multigrid: PETSc with hypre (libpetsc-real-dev).
if(PETSC_FOUND AND MPI_CXX_FOUND)
  add_executable(amg_bench amg_bench.cpp amg_solver.cpp)
  drumhead_compile_settings(amg_bench)
  target_link_libraries(amg_bench PRIVATE drumhead_nested_newton drumhead_bench_truth
    PkgConfig::PETSC MPI::MPI_CXX)
endif()
