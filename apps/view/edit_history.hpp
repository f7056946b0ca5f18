#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/scene_edit.hpp"

namespace sunfleck::view {

// A document and the way back to what it was. Documents are kept whole: meshes are shared, the rest is small.
class EditHistory {
 public:
  static constexpr std::size_t kMostSteps = 500;  // older ones are forgotten

  explicit EditHistory(Document document);

  const Document& now() const { return steps_[at_].document; }
  // A new step. Edits of one `gesture` (other than 0) without another step between them, such as those of one drag, are
  // one step. Throws InvalidInput as edited() does; nothing has changed then.
  void apply(const SceneEdit& edit, std::uint64_t gesture = 0);
  // Whether there was a step to go.
  bool undo();
  bool redo();
  // What undo() and redo() would undo and redo.
  std::optional<std::string> undoes() const;
  std::optional<std::string> redoes() const;

  // Which tree is selected is no step of its own, but comes back with the document. Throws InvalidInput when there is
  // no such tree.
  void select(std::optional<std::size_t> tree);
  // How many changes there have been, undone ones and selections included: what is as old as this is up to date.
  std::uint64_t revision() const { return revision_; }

 private:
  struct Step {
    Document document;
    std::string name;  // of the edit that led here
    std::uint64_t gesture = 0;
  };
  std::vector<Step> steps_;  // the first is what there was before any edit
  std::size_t at_ = 0;
  std::uint64_t revision_ = 0;
};

}  // namespace sunfleck::view
