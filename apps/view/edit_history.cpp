#include "apps/view/edit_history.hpp"

#include "core/require.hpp"

namespace sunfleck::view {

EditHistory::EditHistory(Document document) {
  steps_.push_back({.document = std::move(document), .name = {}});
}

void EditHistory::apply(const SceneEdit& edit, std::uint64_t gesture) {
  Document next = edited(now(), edit);
  const bool continues = gesture != 0 && at_ > 0 && steps_[at_].gesture == gesture;
  steps_.resize(at_ + 1);
  const std::uint64_t stand = changesStand(edit) ? ++stands_ : steps_[at_].stand;
  if (continues) {
    steps_[at_].document = std::move(next);
    steps_[at_].stand = stand;
  } else {
    steps_.push_back({.document = std::move(next), .name = nameOf(edit), .gesture = gesture, .stand = stand});
  }
  if (steps_.size() > kMostSteps + 1) steps_.erase(steps_.begin());
  at_ = steps_.size() - 1;
}

bool EditHistory::undo() {
  if (at_ == 0) return false;
  --at_;
  return true;
}

bool EditHistory::redo() {
  if (at_ + 1 == steps_.size()) return false;
  ++at_;
  return true;
}

std::optional<std::string> EditHistory::undoes() const {
  return at_ == 0 ? std::nullopt : std::optional(steps_[at_].name);
}

std::optional<std::string> EditHistory::redoes() const {
  return at_ + 1 == steps_.size() ? std::nullopt : std::optional(steps_[at_ + 1].name);
}

void EditHistory::select(std::optional<std::size_t> tree) {
  const std::size_t trees = now().scene.stand.trees.size();
  if (tree) require(*tree < trees, "tree", *tree + 1, "one of the stand's trees, 1 to " + std::to_string(trees));
  steps_[at_].document.selected = tree;
}

}  // namespace sunfleck::view
