#include "tests/fuzz/import_target.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>

#include "core/finished_mesh.hpp"
#include "core/require.hpp"
#include "plants/import.hpp"

namespace sunfleck::fuzz {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "%s\n", what.c_str());
  std::abort();
}

// A folder of this process with a material file, which goes away with it; after a crash the file that brought it stays.
class Folder {
 public:
  Folder() {
    fs::create_directories(path);
    std::ofstream(path / "t.mtl") << "newmtl leaf\nKd 0.1 0.3 0.1\nmap_d t.png\nnewmtl bark\nKd 0.3 0.2 0.1\n";
  }
  ~Folder() {
    std::error_code failure;
    fs::remove_all(path, failure);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  // In memory, where there is such a place: files are written thousands of times.
  const fs::path path = (fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path()) /
                        ("sunfleck_fuzz_" + std::to_string(::getpid()));
};

// Half of the image is leaf.
Image halfThere(const fs::path&, std::string_view) {
  return {.width = 2, .height = 1, .channels = {"Y", "A"}, .values = {1.f, 1.f, 1.f, 0.f}};
}

template <typename Import>
void tryToRead(const Import& import) {
  try {
    import();
  } catch (const InvalidInput& e) {
    const std::string message = e.what();
    if (message.empty() || message.find('\n') != std::string::npos) fail("a message of not one line: " + message);
  } catch (const std::exception& e) {
    fail(std::string("ended by something else than a message: ") + e.what());
  }
}

// Finished, in words of another kind than a file's.
void requireReliable(const TreeMesh& mesh) {
  try {
    requireFinished(mesh, "mesh");
  } catch (const InvalidInput& e) {
    fail(std::string("a mesh on which nobody can rely: ") + e.what());
  }
}

}  // namespace

void importBytes(const std::uint8_t* data, std::size_t size, const char* extension) {
  static const Folder folder;
  fs::path file = folder.path / "t";
  file += extension;
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  tryToRead([&] { requireReliable(importTree(file, {}, halfThere).mesh); });
  ImportRules everything;
  everything.leaf = {"*"};
  tryToRead([&] {
    for (const ImportedStand::Kind& kind : importStand(file, everything, halfThere).kinds)
      requireReliable(kind.tree.mesh);
  });
}

}  // namespace sunfleck::fuzz
