// Compiled once for each instruction set (sunfleck_kernel in cmake/module.cmake).
#include "field/detail/cell_exchange.hpp"

namespace sunfleck::SUNFLECK_ISA {
namespace {

using detail::ExchangeElements;
using detail::ExchangeRows;
using Piece = CellPiece;

constexpr std::size_t kLanes = 8;
typedef float Floats __attribute__((vector_size(kLanes * sizeof(float))));

[[gnu::always_inline]] inline Floats load(const float* from) {
  Floats lanes;
  __builtin_memcpy(&lanes, from, sizeof(lanes));
  return lanes;
}
[[gnu::always_inline]] inline void store(Floats lanes, float* to) {
  __builtin_memcpy(to, &lanes, sizeof(lanes));
}
[[gnu::always_inline]] inline float sum(Floats lanes) {
  return ((lanes[0] + lanes[4]) + (lanes[2] + lanes[6])) + ((lanes[1] + lanes[5]) + (lanes[3] + lanes[7]));
}
[[gnu::always_inline]] inline Floats cosine(const ExchangeRows& rows, std::size_t row, const glm::vec3& n) {
  return load(rows.x + row * kLanes) * n.x + load(rows.y + row * kLanes) * n.y + load(rows.z + row * kLanes) * n.z;
}
[[gnu::always_inline]] inline Floats positive(Floats lanes) {
  return lanes > 0.f ? lanes : Floats{};
}

void extinction(const ExchangeRows& rows, const ExchangeElements& elements, const Piece* begin, const Piece* end,
                float per_volume, float* sigma) {
  for (std::size_t row = 0; row < rows.pairs; ++row) {
    Floats total{};
    for (const Piece* piece = begin; piece != end; ++piece) {
      const Floats d = cosine(rows, row, elements.normal[piece->element]);
      total += (piece->area * elements.fullness[piece->element]) * (d > 0.f ? d : -d);
    }
    store(total * per_volume, sigma + row * kLanes);
  }
}

template <std::size_t kBands>
void sendBands(const ExchangeRows& rows, const ExchangeElements& elements, const Piece* begin, const Piece* end,
               float per_volume, const float* radiance, float* source) {
  for (std::size_t row = 0; row < rows.pairs; ++row) {
    Floats up[kBands], down[kBands];
    for (std::size_t band = 0; band < kBands; ++band) up[band] = down[band] = Floats{};
    for (const Piece* piece = begin; piece != end; ++piece) {
      const Floats d =
          cosine(rows, row, elements.normal[piece->element]) * (piece->area * elements.fullness[piece->element]);
      const Floats towards = positive(d), away = positive(-d);
      const float* const front = radiance + std::size_t{piece->element} * 2 * kBands;
      const float* const back = front + kBands;
      for (std::size_t band = 0; band < kBands; ++band) {
        up[band] += towards * front[band] + away * back[band];
        down[band] += towards * back[band] + away * front[band];
      }
    }
    for (std::size_t band = 0; band < kBands; ++band) {
      store(up[band] * per_volume, source + (row * kBands + band) * kLanes);
      store(down[band] * per_volume, source + ((rows.pairs + row) * kBands + band) * kLanes);
    }
  }
}

template <std::size_t kBands>
void receiveBands(const ExchangeRows& rows, const ExchangeElements& elements, const Piece* begin, const Piece* end,
                  const float* radiance, float* irradiance) {
  for (const Piece* piece = begin; piece != end; ++piece, irradiance += 2 * kBands) {
    Floats front[kBands], back[kBands];
    for (std::size_t band = 0; band < kBands; ++band) front[band] = back[band] = Floats{};
    const glm::vec3 normal = elements.normal[piece->element];
    for (std::size_t row = 0; row < rows.pairs; ++row) {
      const Floats d = cosine(rows, row, normal) * load(rows.weight + row * kLanes);
      const Floats towards = positive(d), away = positive(-d);
      for (std::size_t band = 0; band < kBands; ++band) {
        const Floats up = load(radiance + (row * kBands + band) * kLanes),
                     down = load(radiance + ((rows.pairs + row) * kBands + band) * kLanes);
        front[band] += towards * down + away * up;
        back[band] += towards * up + away * down;
      }
    }
    const float fullness = elements.fullness[piece->element];
    for (std::size_t band = 0; band < kBands; ++band) {
      irradiance[band] = fullness * sum(front[band]);
      irradiance[kBands + band] = fullness * sum(back[band]);
    }
  }
}

void send(const ExchangeRows& rows, const ExchangeElements& elements, const Piece* begin, const Piece* end,
          float per_volume, const float* radiance, std::size_t bands, float* source) {
  static_assert(detail::kMostFieldBands == 4);
  if (bands == 1) return sendBands<1>(rows, elements, begin, end, per_volume, radiance, source);
  if (bands == 2) return sendBands<2>(rows, elements, begin, end, per_volume, radiance, source);
  if (bands == 3) return sendBands<3>(rows, elements, begin, end, per_volume, radiance, source);
  sendBands<4>(rows, elements, begin, end, per_volume, radiance, source);
}

void receive(const ExchangeRows& rows, const ExchangeElements& elements, const Piece* begin, const Piece* end,
             const float* radiance, std::size_t bands, float* irradiance) {
  if (bands == 1) return receiveBands<1>(rows, elements, begin, end, radiance, irradiance);
  if (bands == 2) return receiveBands<2>(rows, elements, begin, end, radiance, irradiance);
  if (bands == 3) return receiveBands<3>(rows, elements, begin, end, radiance, irradiance);
  receiveBands<4>(rows, elements, begin, end, radiance, irradiance);
}

}  // namespace

extern const detail::CellExchange cell_exchange;
const detail::CellExchange cell_exchange{extinction, send, receive};

}  // namespace sunfleck::SUNFLECK_ISA
