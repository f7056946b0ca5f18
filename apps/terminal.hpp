#pragma once

#include <string>

#include "core/progress.hpp"

namespace sunfleck::apps {

// A progress bar on stderr, drawn only when that is a terminal and `quiet` is false. Its answers turn to "stop" once
// the user has pressed Ctrl-C: long work then ends with what it has. A second Ctrl-C ends the program
// at once, without half a file.
Progress terminalProgress(const std::string& label, bool quiet);

// Whether Ctrl-C has been pressed.
bool interrupted();
void catchInterrupts();

}  // namespace sunfleck::apps
