#include "bench/measurement.hpp"

#include <fmt/format.h>

#include "core/require.hpp"
#include "plants/import.hpp"
#include "plants/species.hpp"

namespace sunfleck {

int measurement(const std::string& program, int argc, char** argv, const std::function<void(CLI::App&)>& add_options,
                const std::function<void()>& measure) {
  CLI::App app;
  app.name(program);
  add_options(app);
  try {
    app.parse(argc, argv);
    measure();
  } catch (const CLI::ParseError& mistake) {
    return app.exit(mistake) == 0 ? 0 : 2;
  } catch (const InvalidInput& mistake) {
    fmt::print(stderr, "{}: {}\n", program, mistake.what());
    return 2;
  }
  return 0;
}

TreeMesh measuredTree(const std::string& name, std::uint64_t seed, const RandomCrown& crown) {
  if (name == "crown") return randomCrown(crown, seed);
  if (name.find('.') != std::string::npos) return importTree(name).mesh;
  return grow(species(name), seed);
}

}  // namespace sunfleck
