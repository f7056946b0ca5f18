#pragma once

#include "pp_solver/detail/vec.hpp"

// Dense algebra on rows of Vec. With S = double a row of n numbers fills ceil(n / kLanes) Vec, its end is padding; with
// S = Vec each number is a Vec, one lane for each of several matrices.
namespace sunfleck::pp::SUNFLECK_ISA {

// Whether each number is a whole Vec, one lane for each problem.
template <typename S>
constexpr bool kWide = sizeof(S) > sizeof(double);

// How many numbers a Vec of a row holds, and how many Vec hold n numbers.
template <typename S>
constexpr int perVec() {
  return kWide<S> ? 1 : kLanes;
}
// Of wide rows the number is odd: a power of two would put a column's entries into the same few sets of the cache.
template <typename S>
constexpr int rowWidth(int n) {
  return kWide<S> && n > 8 ? n | 1 : (n + perVec<S>() - 1) / perVec<S>();
}

template <typename S>
S* numbers(Vec* row) {
  return reinterpret_cast<S*>(row);
}
template <typename S>
const S* numbers(const Vec* row) {
  return reinterpret_cast<const S*>(row);
}

// The sum of a row's first n numbers' products with another's.
template <typename S>
inline S rowProduct(const Vec* a, const Vec* b, int n) {
  if constexpr (kWide<S>) {
    Vec sum{};
    for (int i = 0; i < n; ++i) sum += a[i] * b[i];
    return sum;
  } else {
    const double *x = numbers<double>(a), *y = numbers<double>(b);
    double sum = 0.;
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n; ++i) sum += x[i] * y[i];
    return sum;
  }
}

// c[i] = sum over j < inner of a(i, j) b[j] for rows i < rows; a(i, j) = a[i * row_step + j * inner_step].
template <typename S, int kRows, int kColumns>
inline void multiplyBlock(Vec* c, const S* a, const Vec* b, int inner, int width, int row_step, int inner_step) {
  Vec sum[kRows][kColumns]{};
  for (int j = 0; j < inner; ++j)
    for (int r = 0; r < kRows; ++r) {
      const S factor = a[r * row_step + j * inner_step];
      for (int k = 0; k < kColumns; ++k) sum[r][k] += factor * b[j * width + k];
    }
  for (int r = 0; r < kRows; ++r)
    for (int k = 0; k < kColumns; ++k) c[r * width + k] = sum[r][k];
}

template <typename S, int kRows>
inline void multiplyRows(Vec* c, const S* a, const Vec* b, int inner, int width, int row_step, int inner_step,
                         int from) {
  int k = from;
  for (; k + 4 <= width; k += 4) multiplyBlock<S, kRows, 4>(c + k, a, b + k, inner, width, row_step, inner_step);
  if (k + 2 <= width) {
    multiplyBlock<S, kRows, 2>(c + k, a, b + k, inner, width, row_step, inner_step);
    k += 2;
  }
  if (k < width) multiplyBlock<S, kRows, 1>(c + k, a, b + k, inner, width, row_step, inner_step);
}

// c = a b, `rows` rows of `width` Vec. upper: only what lies on or above the diagonal is needed.
template <typename S>
inline void multiply(Vec* c, const S* a, const Vec* b, int rows, int inner, int width, int row_step, int inner_step,
                     bool upper = false) {
  constexpr int kPerVec = perVec<S>();
  int i = 0;
  for (; i + 4 <= rows; i += 4)
    multiplyRows<S, 4>(c + i * width, a + i * row_step, b, inner, width, row_step, inner_step, upper ? i / kPerVec : 0);
  for (; i < rows; ++i)
    multiplyRows<S, 1>(c + i * width, a + i * row_step, b, inner, width, row_step, inner_step, upper ? i / kPerVec : 0);
}

// The part of a square matrix below the diagonal, from the part above.
template <typename S>
inline void mirror(Vec* matrix, int n, int width) {
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < i; ++j) numbers<S>(matrix + i * width)[j] = numbers<S>(matrix + j * width)[i];
}

// Cholesky: the upper part of `matrix` (symmetric, positive definite) becomes U with matrix = U^T U, and inverse[i]
// 1 / U(i, i).
template <typename S>
inline void factorise(Vec* matrix, S* inverse, int n, int width) {
  constexpr int kPerVec = perVec<S>();
  for (int j = 0; j < n; ++j) {
    Vec* pivot_row = matrix + j * width;
    for (int k = j / kPerVec * kPerVec; k < j; ++k) numbers<S>(pivot_row)[k] = S{};  // solveLower reads whole Vec
    const S diagonal = root(numbers<S>(pivot_row)[j]);
    inverse[j] = 1. / diagonal;
    for (int k = j / kPerVec; k < width; ++k) pivot_row[k] = pivot_row[k] * inverse[j];
    for (int i = j + 1; i < n; ++i) {
      const S factor = numbers<S>(pivot_row)[i];
      Vec* row = matrix + i * width;
      for (int k = i / kPerVec; k < width; ++k) row[k] -= factor * pivot_row[k];
    }
  }
}

// x = U^-T x, for a row x of n numbers.
template <typename S>
inline void solveLower(const Vec* factor, const S* inverse, Vec* x, int n, int width) {
  constexpr int kPerVec = perVec<S>();
  for (int j = 0; j < n; ++j) {
    const S value = numbers<S>(x)[j] * inverse[j];
    for (int k = j / kPerVec; k < width; ++k) x[k] -= value * factor[j * width + k];
    numbers<S>(x)[j] = value;
  }
}

// x = U^-1 x.
template <typename S>
inline void solveUpper(const Vec* factor, const S* inverse, Vec* x, int n, int width) {
  for (int j = n - 1; j >= 0; --j) {
    const S* row = numbers<S>(factor + j * width);
    S* value = numbers<S>(x);
    S sum = value[j];
    for (int i = j + 1; i < n; ++i) sum -= row[i] * value[i];
    value[j] = sum * inverse[j];
  }
}

// Rows 0 .. n - 1 of `x` (each `width` Vec, as those of the factor) become those of U^-T x: four rows at a time, what
// the rows above them take away as a product.
//   work  4 rows
template <typename S>
inline void solveLowerRows(const Vec* factor, const S* inverse, Vec* x, int n, int width, Vec* work) {
  const int stride = width * perVec<S>();
  for (int first = 0; first < n; first += 4) {
    const int count = n - first < 4 ? n - first : 4;
    multiply<S>(work, numbers<S>(factor) + first, x, count, first, width, 1, stride);
    for (int j = 0; j < count; ++j) {
      Vec* row = x + (first + j) * width;
      for (int k = 0; k < width; ++k) row[k] -= work[j * width + k];
      for (int i = 0; i < j; ++i) {
        const S share = numbers<S>(factor + (first + i) * width)[first + j];
        for (int k = 0; k < width; ++k) row[k] -= share * x[(first + i) * width + k];
      }
      for (int k = 0; k < width; ++k) row[k] = row[k] * inverse[first + j];
    }
  }
}

}  // namespace sunfleck::pp::SUNFLECK_ISA
