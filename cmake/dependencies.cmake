# Every third-party package, in one place, found and never downloaded. The Debian packages stand in packages.txt.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
find_package(glm REQUIRED)
find_package(embree REQUIRED)
find_package(OpenImageIO REQUIRED)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(fmt REQUIRED)
find_package(tinyobjloader REQUIRED)
find_package(TinyGLTF REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(Boost REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(ZLIB REQUIRED)
find_path(Random123_INCLUDE_DIR Random123/philox.h REQUIRED)  # headers alone
find_package(PkgConfig REQUIRED)
pkg_check_modules(epoxy REQUIRED IMPORTED_TARGET epoxy)
find_package(glfw3 REQUIRED)
pkg_check_modules(imgui REQUIRED IMPORTED_TARGET imgui)
find_package(GTest REQUIRED)
find_package(benchmark REQUIRED)

# Ranks on one machine or many; the program is whole without. MPI's own C++ names are given up by all who made them.
set(MPI_CXX_SKIP_MPICXX ON)
find_package(MPI COMPONENTS CXX)

# Debian 12's OpenImageIO target names an OpenCV include folder that the package does not install.
get_target_property(oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
list(FILTER oiio_includes EXCLUDE REGEX "opencv")
set_target_properties(OpenImageIO::OpenImageIO PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${oiio_includes}")

if(NOT OpenVDB_CMAKE_PATH)
  find_path(OpenVDB_CMAKE_PATH FindOpenVDB.cmake
            PATH_SUFFIXES lib/${CMAKE_LIBRARY_ARCHITECTURE}/cmake/OpenVDB lib/cmake/OpenVDB)
endif()
list(APPEND CMAKE_MODULE_PATH "${OpenVDB_CMAKE_PATH}")
find_package(OpenVDB REQUIRED)
find_path(NanoVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)  # headers alone, beside those of OpenVDB
