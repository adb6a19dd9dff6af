// Rows of output within a step of a group of closed loops, by the step's polynomials.
//
// Included only by the kernels; see simd/pack.hpp for why all is inlined or tagged.
#pragma once

#include "solve/loop/workspace.hpp"

namespace bbsim::solve::loop {

template <class Of>
struct RowsWithin : Of {
  using Of::angles, Of::places;
  using Of::lanes, Of::motions, Of::n, Of::nq, Of::packs, Of::rows, Of::s, Of::spin;
  using typename Of::Courses, typename Of::P, typename Of::Pack, typename Of::Workspace;

  template <int coordinates>
  static constexpr int row_size = (coordinates == nq ? n : coordinates) * group;

  // Rows for as many times as a pack has lanes.
  template <int coordinates>
  BBSIM_INLINE static void put_rows(const Workspace& w, P parts, int used, double* to) {
    alignas(64) double polynomial[s + 2][lanes];
    P(1.0).store(polynomial[0]);
    Courses::polynomials(
        P(2.0) * parts - P(1.0), [&](int m, P value) __attribute__((always_inline)) {
          value.store(polynomial[m]);
        });
    constexpr int together = coordinates == nq ? 1 : lanes < 4 ? lanes : 4;
#pragma GCC unroll 1
    for (int first = 0; first < used; first += together) {
#pragma GCC unroll 1
      for (int p = 0; p < packs; ++p) {
        const Courses* const of = w.of[p].courses;
        P q[together][coordinates], v[together][coordinates];
#pragma GCC unroll 4
        for (int l = 0; l < together; ++l) {
#pragma GCC unroll 4
          for (int i = 0; i < coordinates; ++i) q[l][i] = v[l][i] = P(0.0);
        }
#pragma GCC unroll 2
        for (int m = 0; m <= s + 1; ++m) {
#pragma GCC unroll 4
          for (int l = 0; l < together; ++l) {
            const P value(polynomial[m][first + l]);
#pragma GCC unroll 4
            for (int i = 0; i < coordinates; ++i) {
              q[l][i] += of[i / 2].q[i % 2][m] * value;
              if (coordinates == nq && m <= s) v[l][i] += of[i / 2].v[i % 2][m] * value;
            }
          }
        }
        for (int l = 0; l < together && first + l < used; ++l) {
          double* const row = to + (first + l) * row_size<coordinates> + p * lanes;
#pragma GCC unroll 4
          for (int i = 0; i < coordinates; ++i) {
            q[l][i].store(row + motions.of[i].position * group);
            if (coordinates == nq) v[l][i].store(row + motions.of[i].velocity * group);
          }
          if (coordinates == nq) {
            spin_at(w, p, first + l, polynomial).store(row + motions.of[spin].velocity * group);
          }
        }
      }
    }
  }

  BBSIM_INLINE static P spin_at(const Workspace& w, int p, int l,
                                const double (&polynomial)[s + 2][lanes]) {
    const Pack& of = w.of[p];
    P k[s], v[s + 1];
    for (int m = 0; m < s; ++m) {
      k[m] = P(0.0);
      for (int j = 0; j < s; ++j) k[m] += P(w.h * rows.legendre[j][m]) * of.k[j][spin];
    }
    Courses::template integrate<s>(k, P(0.5), of.v[spin], v);
    P sum(0.0);
    for (int m = 0; m <= s; ++m) sum += v[m] * P(polynomial[m][l]);
    return sum;
  }

  [[gnu::flatten]] static void evaluate(void* workspace, const double* times, std::size_t count,
                                        bool places_only, double* to) {
    Workspace& w = *static_cast<Workspace*>(workspace);
    Of::template make_courses<Of::places>(w);
    if (!places_only) Of::template make_courses<Of::angles>(w);
    for (std::size_t first = 0; first < count; first += lanes) {
      const int used = count - first < lanes ? static_cast<int>(count - first) : lanes;
      alignas(64) double parts[lanes];
      for (int l = 0; l < lanes; ++l) {
        parts[l] = (times[first + static_cast<std::size_t>(l < used ? l : 0)] - w.t) / w.h;
      }
      if (places_only) {
        put_rows<2>(w, P::load(parts), used, to + first * row_size<2>);
      } else {
        put_rows<nq>(w, P::load(parts), used, to + first * row_size<nq>);
      }
    }
  }
};

}  // namespace bbsim::solve::loop
