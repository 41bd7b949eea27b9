# find_package(dihaptic): the targets dihaptic::base, contact, scene and dynamics, static libraries.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(fmt)
find_dependency(yaml-cpp)
find_dependency(PNG)
find_dependency(PkgConfig)
# Bullet's own CMake config picks single precision
pkg_check_modules(Bullet REQUIRED IMPORTED_TARGET bullet-float64)
pkg_check_modules(Qhull REQUIRED IMPORTED_TARGET qhull_r)
include(${CMAKE_CURRENT_LIST_DIR}/targets.cmake)
