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
  // Another number whenever scene or effort are others, and the same again once they are the same by undo or redo. What
  // is selected, the model and saved cameras do not count: nothing that is computed of a stand hangs on them.
  std::uint64_t stand() const { return steps_[at_].stand; }

 private:
  struct Step {
    Document document;
    std::string name;  // of the edit that led here
    std::uint64_t gesture = 0;
    std::uint64_t stand = 0;
  };
  std::vector<Step> steps_;  // the first is what there was before any edit
  std::size_t at_ = 0;
  std::uint64_t stands_ = 0;  // there have been
};

}  // namespace sunfleck::view
