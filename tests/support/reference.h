// SPDX-License-Identifier: MIT
#pragma once
// Energies of the study scenes at 32² with exact constraints, offset 0, to all digits that are
// known: found by another program (a study prototype) before this one existed. Unit: mu times the
// lattice's area, primal, true kappa: elastic + volume, which is 1 at rest.
#include <ostream>
#include <string>
#include <vector>

#include "scenes.h"

namespace drumhead::scenes {

struct ReferenceCase {
  std::string name;  ///< letters and digits, for test names
  Scene scene;
  double kappa = 1.0;  ///< ignored where the scene has a mask
  double energy = 0.0;
};
inline void PrintTo(const ReferenceCase& c, std::ostream* out) { *out << c.name; }

/// Scenes whose minimum is found from the harmonic start by every strategy tried.
inline std::vector<ReferenceCase> reference_cases() {
  return {
      {"S1kappa1", sponge(), 1.0, 1.3920794},
      {"S1kappa10", sponge(), 10.0, 2.1374697},
      {"S2kappa1", roundabout(90.0), 1.0, 2.0827889},
      {"S2kappa10", roundabout(90.0), 10.0, 2.2187105},
      {"S2kappa100", roundabout(90.0), 100.0, 2.2846214},
      {"S3", pinch(), 0.0, 1.1267049},
      {"S4kappa1", shift(), 1.0, 1.2596883},
      {"S4kappa10", shift(), 10.0, 1.530912},
      {"S4kappa100", shift(), 100.0, 1.7914657},
  };
}

/// More of them, stiffer or turned further.
inline std::vector<ReferenceCase> further_reference_cases() {
  return {
      {"S1kappa100", sponge(), 100.0, 2.7298491},
      {"S1kappa10000", sponge(), 1e4, 2.8245018},
      {"S2kappa10000", roundabout(90.0), 1e4, 2.3213859},
      {"S2by135kappa1", roundabout(135.0), 1.0, 3.0430186},
      {"S2by135kappa10", roundabout(135.0), 10.0, 3.6812226},
      {"S2by135kappa100", roundabout(135.0), 100.0, 3.916544},
      {"S2by135kappa10000", roundabout(135.0), 1e4, 4.0385807},
      {"S4kappa10000", shift(), 1e4, 1.8856549},
      {"S5kappa1", fold(), 1.0, 1.2695584},
  };
}

}  // namespace drumhead::scenes
