// How long importing takes beside the library's own reading: an OBJ of a tree, in the units of what tinyobjloader takes
// for the same file, and a million leaves from a .glb. Of ../shared/trees/AlmondWP.obj where it is there, else of a
// tree of ours.
#include <benchmark/benchmark.h>
#include <tiny_obj_loader.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "plants/import.hpp"
#include "plants/random_leaves.hpp"
#include "plants/species.hpp"
#include "plants/write_gltf.hpp"
#include "plants/write_obj.hpp"

namespace {

using namespace sunfleck;
namespace fs = std::filesystem;

// A folder of this process that goes away with it.
class Folder {
 public:
  Folder() { fs::create_directories(path); }
  ~Folder() {
    std::error_code failure;
    fs::remove_all(path, failure);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const fs::path path = fs::temp_directory_path() / ("sunfleck_bench_import_" + std::to_string(::getpid()));
};

const fs::path& folder() {
  static const Folder made;
  return made.path;
}

const fs::path& objFile() {
  static const fs::path file = [] {
    fs::path shared = fs::path(SUNFLECK_SOURCE_DIR) / ".." / "shared" / "trees" / "AlmondWP.obj";
    if (fs::exists(shared)) return shared;
    fs::path own = folder() / "maple.obj";
    writeObj(own, grow(species("maple"), 1));
    return own;
  }();
  return file;
}

void obj(benchmark::State& state) {
  const fs::path& file = objFile();
  for (auto _ : state) benchmark::DoNotOptimize(importTree(file).mesh.leaf_count);
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(fs::file_size(file)));
}
BENCHMARK(obj)->Unit(benchmark::kMillisecond);

void objByTinyobjloader(benchmark::State& state) {
  const fs::path& file = objFile();
  const std::string folder_of_materials = file.parent_path().string() + "/";
  for (auto _ : state) {
    tinyobj::attrib_t attributes;
    std::vector<tinyobj::shape_t> shapes;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    if (!tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, file.c_str(),
                          folder_of_materials.c_str()))
      state.SkipWithError("tinyobjloader cannot read the file");
    benchmark::DoNotOptimize(attributes.vertices.size());
  }
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(fs::file_size(file)));
}
BENCHMARK(objByTinyobjloader)->Unit(benchmark::kMillisecond);

void glbOfLeaves(benchmark::State& state) {
  const auto leaves = static_cast<int>(state.range(0));
  const fs::path file = folder() / "leaves.glb";
  writeGltf(file, randomCrown({.leaf_side = 0.005f, .leaves = leaves}, 1));
  for (auto _ : state) {
    const ImportedTree tree = importTree(file);
    if (tree.mesh.leaf_count != static_cast<std::uint32_t>(leaves)) state.SkipWithError("leaves are lost");
  }
}
BENCHMARK(glbOfLeaves)->Arg(10'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);

}  // namespace
