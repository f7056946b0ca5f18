#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <span>

#include "core/progress.hpp"
#include "render/scene.hpp"
#include "spp/power_table.hpp"

namespace sunfleck::view {

// (R27) Tables of the exact solution, each made once for its leaves: in the background, for the thread that draws to
// find them there.
class ExactTables {
 public:
  // Makes what there is not yet of the kinds' leaves. Throws std::runtime_error("interrupted") when `progress` ends it.
  void make(std::span<const TreeKind> kinds, const Progress& progress = {});
  // That of such leaves, made now where there is none.
  spp::PowerTable of(const LeafOptics& leaf);
  std::size_t made() const;  // so far

 private:
  using Key = std::pair<float, float>;  // reflectance and transmittance, all that it depends on
  mutable std::mutex mutex_;
  std::map<Key, spp::PowerTable> tables_;
};

}  // namespace sunfleck::view
