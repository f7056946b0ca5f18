#pragma once

namespace sunfleck::gl {

// How leaves pass light on: direct light alone; the slab's light; the slab's light as far as the crown is like a slab.
enum class ShadingModel { ss, spp, sppg };

}  // namespace sunfleck::gl
