#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/view/edit_history.hpp"
#include "apps/view/navigation.hpp"
#include "apps/view/stand_worker.hpp"
#include "render/tone_mapping.hpp"

namespace sunfleck::view {

// What the picture shows; not undone.
enum class Layer { total, direct, single, multiple, sky, depth, thickness, compensation };
inline constexpr std::array kLayers{Layer::total, Layer::direct, Layer::single,    Layer::multiple,
                                    Layer::sky,   Layer::depth,  Layer::thickness, Layer::compensation};
std::string nameOf(Layer layer);

inline constexpr std::array kTones{ToneCurve::clamp, ToneCurve::filmic};
std::string nameOf(ToneCurve tone);

enum class Comparison { off, wipe, flip, difference };

struct Look {
  Navigation navigation = Navigation::orbit;
  Layer layer = Layer::total;
  Display display{3.f};      // radiance to brightness
  int samples = 16;          // per pixel, once nothing moves
  bool fewer_leaves = true;  // where they are small (level of detail)
  Comparison comparison = Comparison::off;
  std::optional<Model> other;     // what B is; none: the reference
  float wipe = 0.5f;              // share of the width that shows A
  double reference_noise = 0.01;  // at which Monte Carlo ends: standard error of the pixels by the mean
  float difference_scale = 0.f;   // largest difference that colours tell; 0: that of the picture
};

// What models need beside what every stand has.
struct ModelNeeds {
  bool exact = false;  // tables of the exact solution
  bool field = false;  // the light field
  bool hold(const ModelNeeds& other) const { return exact >= other.exact && field >= other.field; }
};

// What a person works on: the document with its history, the camera, how it is looked at, and the work in the
// background. It knows no window and no OpenGL.
class Session {
 public:
  // Reads the scene in the background.
  Session(std::string name, std::function<Document()> read);

  // Hands results and failures of the background on; wishes for what the document needs. Throws what reading the scene
  // threw.
  void advance();
  bool loaded() const { return history_.has_value(); }  // nothing below may be asked before
  const Document& document() const { return history_->now(); }
  const EditHistory& history() const { return *history_; }

  // Throw InvalidInput, as EditHistory does. Afterwards message() says what was done.
  void edit(const SceneEdit& edit, std::uint64_t gesture = 0);
  void undo();
  void redo();
  void select(std::optional<std::size_t> tree);
  // The same, with what was wrong in message() instead.
  void attempt(const std::function<void()>& work);
  std::uint64_t newGesture() { return ++gesture_; }

  // Edits made of others. All throw InvalidInput.
  void moveSelected(glm::vec2 by, std::uint64_t gesture = 0);  // [m]
  void turnSelected(float by, std::uint64_t gesture = 0);      // counter-clockwise from above [rad]
  void addTree(glm::vec2 place, std::uint32_t kind);
  void copySelected(glm::vec2 by);
  void removeSelected();
  // Trees of a kind at random places around one, none nearer to another tree than `spacing`. Where all places are taken
  // nothing is done.
  void paint(glm::vec2 place, float radius, float spacing, std::uint32_t kind, std::uint64_t gesture = 0);
  // Where the sun stands on a date (2026-06-21) at a time (12:00, UTC) and a place [degrees]; +x is east, +y north.
  void turnSunByDate(std::size_t sun, const std::string& date, const std::string& time, double latitude,
                     double longitude);
  // Grows a species or reads a file in the background, and adds it as a kind, of which a tree stands beside the others,
  // towards +x.
  void addKind(const std::string& species_or_file, std::uint64_t seed);
  // Reads a panorama in the background, and makes it the sky. Its brightness stays where it was one before.
  //   rotation  azimuth of its middle column [rad]
  void setSkyImage(const std::string& file, float rotation);
  // Reads an image of a kind's leaves in the background.
  void setLeafImage(std::size_t kind, LeafImage image, const std::string& file);
  std::uint32_t selectedKind() const;  // of the selected tree, or the first
  float groundHeight() const;          // [m]

  Camera camera;  // as looked through now; its size is that of the picture
  Look look;
  // Gives the camera's picture this size; the first time so that all that the scene's camera shows is in it.
  void fit(glm::ivec2 size);
  void showWholeStand();
  void goTo(const std::string& saved_camera);

  // The geometry that waits to be drawn, if there is one. Release it when it has been.
  std::optional<StandWorker::Result> take() { return worker_.take(); }
  void release(const StandWorker::Result& shown);
  // The scene of the last result, with what follows from its leaves' textures; none before the first.
  const std::shared_ptr<const Scene>& shownScene() const { return shown_scene_; }
  // Whether what is drawn is as old as the document.
  bool upToDate() const;
  // Whether a model can be drawn without waiting for what it needs.
  bool drawable(Model model) const {
    return shown_needs_.hold({.exact = model == Model::pp, .field = model == Model::field});
  }
  ExactTables& exactTables() { return worker_.tables(); }
  StandWorker::State work() const { return worker_.state(); }
  void cancel();

  // Writes a file in the background; then message() tells of it.
  void write(const std::filesystem::path& file, std::function<void()> writing);
  std::optional<std::string> writes() const;  // what is being written
  // Work of which message() tells the end: growing, reading, writing.
  bool hasTasks() const { return !prepared_.empty() || !writings_.empty(); }
  // How the light field that is shown was made, for people; empty where none is needed.
  const std::string& fieldText() const { return field_text_; }
  // Whether the field of the document's stand is there to be drawn, if only its preview.
  bool showsField() const { return loaded() && shown_ == history_->stand() + 1 && shown_needs_.field; }
  bool needsField() const { return needs().field; }
  const std::vector<ProductCost>& lastCosts() const { return last_costs_; }  // of the last change
  double lastSeconds() const { return last_seconds_; }
  // Of the first update since the scene was read or its quality changed: all there is, made from nothing.
  double preparedSeconds() const { return prepared_seconds_; }
  std::string lastCostText() const;  // for people
  // Members made and adjusted since the counts were last cleared, of each product.
  const std::vector<ProductCost>& recomputed() const { return recomputed_; }
  void clearRecomputed() { recomputed_.clear(); }

  const std::string& message() const { return message_; }
  bool messageIsError() const { return message_is_error_; }
  void say(std::string message, bool error = false);

 private:
  struct Writing {
    std::filesystem::path file;
    std::future<void> ended;
  };
  ModelNeeds needs() const;
  // Makes an edit in the background, to be done when it is there.
  void prepare(const std::string& what, std::function<SceneEdit()> make);
  void endWritings();

  std::optional<EditHistory> history_;
  std::shared_ptr<std::optional<Document>> read_;                    // by the worker
  std::vector<std::shared_ptr<std::optional<SceneEdit>>> prepared_;  // by the worker
  std::uint64_t wished_ = 0, shown_ = 0;                             // stands of the history, one more than its numbers
  ModelNeeds wished_needs_, answered_needs_, shown_needs_;           // answered: made, failed or cancelled
  std::shared_ptr<const Scene> shown_scene_;
  std::vector<Writing> writings_;
  std::uint64_t gesture_ = 0, strokes_ = 0;
  std::vector<ProductCost> last_costs_, recomputed_;
  double last_seconds_ = 0., prepared_seconds_ = 0.;
  bool prepares_ = false;  // the last change made all from nothing
  std::string field_text_;
  bool fitted_ = false;
  std::string message_;
  bool message_is_error_ = false;
  StandWorker worker_;  // last: it ends before what it works on
};

}  // namespace sunfleck::view
