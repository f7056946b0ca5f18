# Writes build/.../generated/commit.hpp with the commit that is built, at every build, touching it only when it changed.
add_custom_target(sunfleck_commit
  COMMAND ${CMAKE_COMMAND} -D SOURCE=${PROJECT_SOURCE_DIR} -D OUTPUT=${PROJECT_BINARY_DIR}/generated/commit.hpp
          -P ${PROJECT_SOURCE_DIR}/cmake/write_commit.cmake
  BYPRODUCTS ${PROJECT_BINARY_DIR}/generated/commit.hpp
  COMMENT "")
