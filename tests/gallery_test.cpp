// Check that a sheet of all species and some files shows a tree in each of its pictures.
#include "apps/gallery.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "apps/thumbnail.hpp"
#include "plants/species.hpp"
#include "render/image_file.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;

// Check pictures by their pixels that are not the background's: some, as even a leaf is seen, and not all.
TEST(Gallery, ShowsEverySpeciesAndFile) {
  const TemporaryFolder folder;
  const std::string leaf = "v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl leaf\nf 1 2 3 4\n";
  const auto object = folder.write("leaf.obj", leaf),
             list = folder.write("leaves.txt", "0.1 0 0 1 0 0 1\n0.2 1 1 2 0 1 1\n");
  const auto file = folder / "sheet.png";
  ASSERT_TRUE(apps::writeGallery(file, {object.string(), list.string()}, {}, {.quiet = true}));
  const Image sheet = readImage(file, ImageValues::as_they_stand);
  const int pictures = static_cast<int>(speciesNames().size()) + 2;
  constexpr int columns = 7, side = apps::kThumbnailPixels;
  ASSERT_GT(pictures, columns);
  const int rows = (pictures + columns - 1) / columns, gap = (sheet.width - columns * side) / (columns + 1);
  ASSERT_EQ(sheet.width, columns * (side + gap) + gap);
  ASSERT_EQ((sheet.height - gap) % rows, 0);
  const std::size_t channels = sheet.channels.size();
  for (int i = 0; i < pictures; ++i) {
    const int left = gap + i % columns * (side + gap), top = gap + i / columns * ((sheet.height - gap) / rows);
    const auto at = [&](int x, int y) {
      return &sheet.values[channels * static_cast<std::size_t>((top + y) * sheet.width + left + x)];
    };
    int shown = 0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) shown += !std::equal(at(x, y), at(x, y) + 3, at(0, 0));
    EXPECT_GT(shown, side) << i;
    EXPECT_LT(shown, side * side * 95 / 100) << i;
  }
}
