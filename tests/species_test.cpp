#include "plants/species.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/require.hpp"
#include "tests/temporary_folder.hpp"

using namespace sunfleck;
namespace fs = std::filesystem;

namespace {

class SpeciesFile : public testing::Test {
 protected:
  WeberPenn read(const std::string& text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return readSpecies(file_);
  }

  // The message reading ends with, from the line's number on; empty when it succeeds.
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const InvalidInput& e) {
      const std::string message = e.what();
      EXPECT_TRUE(message.starts_with(file_.string() + ":")) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
      return message.substr(file_.string().size() + 1);
    }
    return "";
  }

  TemporaryFolder folder_;
  fs::path file_ = folder_ / "tree.toml";
};

}  // namespace

// Check that every species of the folder is carried within the program, word for word, and can be grown; and that those
// of the paper and the other sources are there.
TEST(Species, AreTheFilesOfTheFolder) {
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(fs::path(SUNFLECK_SOURCE_DIR) / "plants" / "species")) {
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string text(std::istreambuf_iterator<char>(in), {});
    EXPECT_EQ(speciesText(entry.path().stem().string()), text) << entry.path();
    ++files;
  }
  const std::vector<std::string> names = speciesNames();
  EXPECT_EQ(names.size(), files);
  EXPECT_TRUE(std::is_sorted(names.begin(), names.end()));
  for (const std::string& name : names) EXPECT_NO_THROW(validate(species(name))) << name;
  for (const std::string expected : {"acer",
                                     "apple",
                                     "black_oak",
                                     "black_tupelo",
                                     "ca_black_oak",
                                     "callistemon",
                                     "cambridge_oak",
                                     "cherry",
                                     "douglas_fir",
                                     "eastern_cottonwood",
                                     "european_larch",
                                     "hill_cherry",
                                     "hill_cherry_in_leaf",
                                     "japanese_maple",
                                     "lombardy_poplar",
                                     "maple",
                                     "quaking_aspen",
                                     "sassafras",
                                     "silver_birch",
                                     "small_maple",
                                     "small_pine",
                                     "tamarack",
                                     "weeping_willow",
                                     "white_birch"})
    EXPECT_NE(std::find(names.begin(), names.end(), expected), names.end()) << expected;
}

// Check that an unknown species is answered with the names there are.
TEST(Species, UnknownNameListsTheKnown) {
  try {
    species("palm");
    FAIL() << "there is a palm";
  } catch (const InvalidInput& e) {
    const std::string message = e.what();
    EXPECT_TRUE(message.starts_with("species = palm: must be one of acer, apple, ")) << message;
    EXPECT_NE(message.find("weeping_willow"), std::string::npos) << message;
  }
}

// Check that keys reach their parameters, crowns by name and by the paper's number, and what is left out stays.
TEST_F(SpeciesFile, SetsWhatItSays) {
  const WeberPenn p = read(
      "name = \"Mine\"\nsource = \"me\"\n[tree]\nshape = 8\nscale = 7\nlevels = 4\nbase_splits = -2\n"
      "[leaves]\nleaves = -5\nleaf_shape = \"maple\"\nblossom_shape = \"elliptic\"\nleaf_petiole = 0.5\n"
      "[pruning]\nprune_ratio = 1.0\n[level0]\nbase_size = 0.25\n[level3]\ncurve_v = -30.0\nbranches = 12\n");
  EXPECT_EQ(p.shape, WeberPenn::Shape::envelope);
  EXPECT_EQ(p.scale, 7.f);
  EXPECT_EQ(p.levels, 4);
  EXPECT_EQ(p.base_splits, -2);
  EXPECT_EQ(p.leaves, -5);
  EXPECT_EQ(p.leaf_shape, LeafShape::maple);
  EXPECT_EQ(p.blossom_shape, LeafShape::elliptic);
  EXPECT_EQ(p.leaf_petiole, 0.5f);
  EXPECT_EQ(p.prune_ratio, 1.f);
  EXPECT_EQ(p.level[0].base_size, 0.25f);
  EXPECT_EQ(p.level[3].curve_v, -30.f);
  EXPECT_EQ(p.level[3].branches, 12);
  EXPECT_EQ(p.ratio, WeberPenn{}.ratio);
  EXPECT_EQ(p.level[1].length, WeberPenn{}.level[1].length);
  EXPECT_EQ(read("[tree]\nshape = \"tend_flame\"\n").shape, WeberPenn::Shape::tend_flame);
  EXPECT_EQ(speciesOrFile(file_.string()).shape, WeberPenn::Shape::tend_flame);
}

// Check that each wrong value is refused in one line with the file, the line, the field, the value and the rule.
TEST_F(SpeciesFile, RefusesWhatIsWrong) {
  EXPECT_EQ(refusal("[tree]\nscale = -1.0\n"), "2: tree.scale = -1: must be a number in [0.01, 1000]");
  EXPECT_EQ(refusal("[tree]\nscale = nan\n"), "2: tree.scale = nan: must be a number in [0.01, 1000]");
  EXPECT_EQ(refusal("[tree]\nscale = \"tall\"\n"), "2: tree.scale = 'tall': must be a number in [0.01, 1000]");
  EXPECT_EQ(refusal("[tree]\nscale = 10.0\nscale_v = 10.0\n"), "3: tree.scale_v = 10: must be a number in [0, 9.5]");
  EXPECT_EQ(refusal("[tree]\nlevels = 5\n"), "2: tree.levels = 5: must be a whole number in [1, 4]");
  EXPECT_EQ(refusal("[tree]\nlevels = 2.5\n"), "2: tree.levels = 2.5: must be a whole number in [1, 4]");
  EXPECT_EQ(refusal("[level1]\nbranches = 9223372036854775807\n"),
            "2: level1.branches = 9223372036854775807: must be a whole number in [-1000, 1000]");
  EXPECT_EQ(refusal("[tree]\nshape = 9\n").substr(0, 46), "2: tree.shape = 9: must be 0 to 8 or one of \"c");
  EXPECT_EQ(refusal("[leaves]\nleaf_shape = \"star\"\n").substr(0, 45),
            "2: leaves.leaf_shape = 'star': must be one of");
  EXPECT_EQ(refusal("[leaves]\nleaf_size = 1.0\n").substr(0, 34), "2: unknown key \"leaves.leaf_size\":");
  EXPECT_EQ(refusal("[level4]\nlength = 1.0\n").substr(0, 32), "1: unknown key \"level4\": must be");
  EXPECT_EQ(refusal("tree = 3\n"), "1: tree = 3: must be a table: [tree]");
  EXPECT_EQ(refusal("name = 3\n"), "1: name = 3: must be a text in quotes");
  EXPECT_NE(refusal("[tree\n"), "");
  EXPECT_THROW(readSpecies("/nowhere/tree.toml"), InvalidInput);
  EXPECT_THROW(readSpecies(fs::temp_directory_path()), InvalidInput);
}
