#include "apps/view/gui.hpp"

#include <imgui.h>
// The backends lie beside it.
#include <backends/imgui_impl_opengl3.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>

namespace sunfleck::view {
namespace {

constexpr float kLetters = 16.f;  // [pixel]
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

void chooseFont(ImGuiIO& io, float scale) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(kFont, ignored)) {
    static const ImWchar kLetterRanges[] = {0x20, 0xff, 0x370, 0x3ff, 0x2000, 0x206f, 0x2190, 0x22ff, 0};
    io.Fonts->AddFontFromFileTTF(kFont, kLetters * scale, nullptr, kLetterRanges);
  } else {  // the built-in letters are 13 pixels high
    io.FontGlobalScale = kLetters / 13.f * scale;
  }
}

void chooseStyle(float scale) {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = 0.f;
  style.WindowBorderSize = 0.f;
  style.FrameRounding = 4.f;
  style.GrabRounding = 4.f;
  style.TabRounding = 4.f;
  style.WindowPadding = {10.f, 8.f};
  style.FramePadding = {8.f, 4.f};
  style.ItemSpacing = {8.f, 6.f};
  style.ScaleAllSizes(scale);
  const ImVec4 leaf(0.36f, 0.62f, 0.33f, 1.f), dim(0.25f, 0.40f, 0.25f, 1.f), ground(0.105f, 0.115f, 0.11f, 1.f);
  auto& colours = style.Colors;
  colours[ImGuiCol_WindowBg] = ground;
  colours[ImGuiCol_PopupBg] = {0.08f, 0.09f, 0.085f, 0.97f};
  colours[ImGuiCol_FrameBg] = {0.19f, 0.21f, 0.20f, 1.f};
  colours[ImGuiCol_FrameBgHovered] = {0.24f, 0.28f, 0.25f, 1.f};
  colours[ImGuiCol_FrameBgActive] = {0.28f, 0.34f, 0.29f, 1.f};
  colours[ImGuiCol_Header] = colours[ImGuiCol_Button] = colours[ImGuiCol_TabActive] = dim;
  colours[ImGuiCol_HeaderHovered] = colours[ImGuiCol_ButtonHovered] = colours[ImGuiCol_TabHovered] = leaf;
  colours[ImGuiCol_HeaderActive] = colours[ImGuiCol_ButtonActive] = leaf;
  colours[ImGuiCol_SliderGrab] = colours[ImGuiCol_CheckMark] = colours[ImGuiCol_SliderGrabActive] = leaf;
  colours[ImGuiCol_Tab] = {0.16f, 0.20f, 0.17f, 1.f};
  colours[ImGuiCol_PlotHistogram] = colours[ImGuiCol_PlotLines] = leaf;
}

void mapKeys(ImGuiIO& io) {
  io.KeyMap[ImGuiKey_Tab] = kTab;
  io.KeyMap[ImGuiKey_LeftArrow] = kLeft;
  io.KeyMap[ImGuiKey_RightArrow] = kRight;
  io.KeyMap[ImGuiKey_UpArrow] = kUp;
  io.KeyMap[ImGuiKey_DownArrow] = kDown;
  io.KeyMap[ImGuiKey_Home] = kHome;
  io.KeyMap[ImGuiKey_End] = kEnd;
  io.KeyMap[ImGuiKey_Delete] = kDelete;
  io.KeyMap[ImGuiKey_Backspace] = kBackspace;
  io.KeyMap[ImGuiKey_Enter] = kEnter;
  io.KeyMap[ImGuiKey_Escape] = kEscape;
  for (const char letter : {'A', 'C', 'V', 'X', 'Y', 'Z'}) {
    const ImGuiKey_ key = letter == 'A'   ? ImGuiKey_A
                          : letter == 'C' ? ImGuiKey_C
                          : letter == 'V' ? ImGuiKey_V
                          : letter == 'X' ? ImGuiKey_X
                          : letter == 'Y' ? ImGuiKey_Y
                                          : ImGuiKey_Z;
    io.KeyMap[key] = letter;
  }
}

}  // namespace

Gui::Gui(float scale) : context_(ImGui::CreateContext()) {
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;  // nothing is left behind
  chooseFont(io, scale);
  chooseStyle(scale);
  mapKeys(io);
  if (!ImGui_ImplOpenGL3_Init("#version 450 core")) {
    ImGui::DestroyContext(context_);
    throw std::runtime_error("Dear ImGui finds no OpenGL (libGL.so.1)");
  }
}

Gui::~Gui() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext(context_);
}

void Gui::begin(const Input& input, float seconds) {
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {static_cast<float>(std::max(input.size.x, 1)), static_cast<float>(std::max(input.size.y, 1))};
  io.DeltaTime = std::max(seconds, 1e-4f);
  io.MousePos = {input.mouse.x, input.mouse.y};
  for (int button = 0; button < 3; ++button) io.MouseDown[button] = input.buttons[button];
  io.MouseWheel += input.wheel;
  std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
  for (std::size_t key = 0; key < input.held.size(); ++key) io.KeysDown[key] = input.held[key];
  for (const int key : input.pressed) io.KeysDown[key] = true;
  io.KeyShift = input.held[kShift];
  io.KeyCtrl = input.held[kControl];
  for (const char32_t letter : input.typed) io.AddInputCharacter(letter);
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

void Gui::draw() {
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

bool Gui::wantsMouse() const {
  return ImGui::GetIO().WantCaptureMouse;
}

bool Gui::wantsKeys() const {
  return ImGui::GetIO().WantTextInput;
}

}  // namespace sunfleck::view
