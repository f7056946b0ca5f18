#include "render/gl/stand_instances.hpp"

#include <gtest/gtest.h>

#include <glm/trigonometric.hpp>

namespace {

using namespace sunfleck;

// (R4) Check who shades whom: with the sun overhead trees 3 m apart do not meet a map 4 m wide at 5 m distance; a low
// sun brings those along its way together, not those across it.
TEST(R4_StandInstances, KnowWhoMayStandInTheLight) {
  // A map of 16 x 16 pixels over 4 x 4 m.
  gl::SunMap map{
      .axes = axesAlong({0.f, 0.f, -1.f}), .corner = glm::vec2(-2.f), .pixel_size = 0.25f, .size = glm::ivec2(16)};
  Stand stand{.trees = {{.position = {0.f, 0.f, 0.f}}, {.position = {3.f, 0.f, 0.f}}, {.position = {0.f, 9.f, 0.f}}},
              .period = {}};
  const auto neighbours = [](const gl::StandInstances& s, std::size_t i) {
    return s.drawn[i].neighbours_end - s.drawn[i].first_neighbour;
  };
  const gl::GroundDisc ground{.centre = glm::vec3(0.f), .radius = 1.f};
  const gl::StandInstances overhead = gl::standInstances(stand, glm::ivec2(8), map, ground);
  ASSERT_EQ(overhead.drawn.size(), 3u);
  EXPECT_EQ(neighbours(overhead, 0), 2u);
  EXPECT_EQ(neighbours(overhead, 2), 1u);
  EXPECT_EQ(overhead.neighbours[overhead.drawn[1].first_neighbour].displacement, glm::vec3(0.f));
  EXPECT_EQ(overhead.neighbours[overhead.drawn[1].first_neighbour].tree, 1u);
  EXPECT_EQ(overhead.neighbours[overhead.drawn[1].first_neighbour + 1].displacement, glm::vec3(-3.f, 0.f, 0.f));

  map.axes = axesAlong(sunlight(glm::radians(80.f), glm::radians(90.f)));  // along y
  const gl::StandInstances low = gl::standInstances(stand, glm::ivec2(8), map, ground);
  EXPECT_EQ(neighbours(low, 2), 3u);

  stand.trees.resize(1);
  stand.period = glm::vec2(5.f);
  map.axes = axesAlong({0.f, 0.f, -1.f});
  const gl::StandInstances periodic = gl::standInstances(stand, glm::ivec2(8), map, ground);
  EXPECT_EQ(periodic.drawn.size(), 9u);
  EXPECT_EQ(neighbours(periodic, 0), 1u);
  EXPECT_EQ(neighbours(periodic, 8), 1u);
}

}  // namespace
