#include "apps/view/exact_tables.hpp"

#include <stdexcept>
#include <vector>

#include "render/compare/exact_powers.hpp"

namespace sunfleck::view {

void ExactTables::make(std::span<const TreeKind> kinds, const Progress& progress) {
  std::map<Key, LeafOptics> missing;
  {
    const std::lock_guard lock(mutex_);
    for (const TreeKind& kind : kinds)
      for (const LeafOptics& leaf : kind.leaf)
        if (const Key key(leaf.reflectance, leaf.transmittance); !tables_.contains(key)) missing.emplace(key, leaf);
  }
  double done = 0.;
  for (const auto& [key, leaf] : missing) {
    if (!goOn(progress, done)) throw std::runtime_error("interrupted");
    of(leaf);
    done += 1. / static_cast<double>(missing.size());
  }
}

std::size_t ExactTables::made() const {
  const std::lock_guard lock(mutex_);
  return tables_.size();
}

spp::PowerTable ExactTables::of(const LeafOptics& leaf) {
  const Key key(leaf.reflectance, leaf.transmittance);
  {
    const std::lock_guard lock(mutex_);
    if (const auto found = tables_.find(key); found != tables_.end()) return found->second;
  }
  spp::PowerTable made = exactPowerTable(leaf);  // without the lock: whoever draws must not wait for it
  const std::lock_guard lock(mutex_);
  return tables_.emplace(key, std::move(made)).first->second;
}

}  // namespace sunfleck::view
