#pragma once

// The kinds of quantity that the shared formulas are written in. All are plain numbers to the machine; the names say
// the unit to the reader. In GLSL the same names are macros for float.
namespace sunfleck {
using Number = float;         // [1]
using Length = float;         // [m]
using InverseLength = float;  // [1/m]
}  // namespace sunfleck
