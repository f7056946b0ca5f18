#include "apps/gallery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "apps/lettering.hpp"
#include "apps/terminal.hpp"
#include "apps/thumbnail.hpp"
#include "core/require.hpp"
#include "core/whole_file.hpp"
#include "plants/species.hpp"
#include "plants/weber_penn.hpp"
#include "render/image_file.hpp"
#include "render/scene_file.hpp"

namespace sunfleck::apps {
namespace {

constexpr int kColumns = 7, kGap = 8, kText = 2 * kLetterHeight + 14;  // [pixel]
constexpr std::size_t kMostFiles = 200;
constexpr int kTile = kThumbnailPixels;
constexpr std::uint8_t kPaper = 255;

Sheet blank(std::size_t pictures) {
  const int columns = std::min(kColumns, static_cast<int>(pictures));
  const int rows = (static_cast<int>(pictures) + columns - 1) / columns;
  Sheet sheet{.width = columns * (kTile + kGap) + kGap, .height = rows * (kTile + kText + kGap) + kGap, .colours = {}};
  sheet.colours.assign(3 * static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height), kPaper);
  return sheet;
}

void draw(Sheet& sheet, std::size_t number, const std::string& name, const TreeMesh& mesh) {
  const int columns = (sheet.width - kGap) / (kTile + kGap);
  const int left = kGap + static_cast<int>(number) % columns * (kTile + kGap);
  const int top = kGap + static_cast<int>(number) / columns * (kTile + kText + kGap);
  const std::vector<std::uint8_t> picture = thumbnail(mesh);
  for (int row = 0; row < kTile; ++row) {
    const auto from = picture.begin() + std::ptrdiff_t{3} * row * kTile;
    std::copy(from, from + std::ptrdiff_t{3} * kTile,
              sheet.colours.begin() + std::ptrdiff_t{3} * ((top + row) * sheet.width + left));
  }
  const int size = static_cast<int>(name.size()) * 2 * kLetterWidth <= kTile ? 2 : 1;
  write(sheet, name, left, top + kTile + 2, size);
  write(sheet, fmt::format("{} leaves, {:.4g} m2, {:.3g} m", mesh.leaf_count, leafArea(mesh), bounds(mesh).size().z),
        left, top + kTile + 4 + 2 * kLetterHeight, 1);
}

// Of a scene, which can say how its file is to be read, the first kind.
std::shared_ptr<const TreeMesh> treeOf(const std::string& file, const ImportRules& rules) {
  if (std::filesystem::path(file).extension() == ".toml") return readScene(file).kinds.front().mesh;
  return std::make_shared<const TreeMesh>(importTree(file, rules, readOpacity).mesh);
}

}  // namespace

bool writeGallery(const std::filesystem::path& sheet_file, const std::vector<std::string>& files,
                  const ImportRules& rules, const RunOptions& run) {
  requireNamed(sheet_file, ".png");
  requireWritable(sheet_file);
  require(files.size() <= kMostFiles, "number of files for --gallery", files.size(), "at most 200");
  const std::vector<std::string> names = speciesNames();
  Sheet sheet = blank(names.size() + files.size());
  const Progress progress = terminalProgress("drawing", run.quiet);
  std::size_t done = 0;
  const auto drawAt = [&](std::size_t place, const std::string& name, const TreeMesh& mesh) {
    draw(sheet, place, name, mesh);
    return progress(static_cast<double>(++done) / static_cast<double>(names.size() + files.size()));
  };
  // Files first: one that cannot be read is refused before long work.
  for (std::size_t i = 0; i < files.size(); ++i)
    if (!drawAt(names.size() + i, std::filesystem::path(files[i]).filename().string(), *treeOf(files[i], rules)))
      return false;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (!drawAt(i, names[i], grow(species(names[i]), run.seed))) return false;
  writePng(sheet_file, sheet.width, sheet.height, sheet.colours);
  return true;
}

}  // namespace sunfleck::apps
