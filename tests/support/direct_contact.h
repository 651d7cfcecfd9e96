// Normal contact solved directly: the authority for the iterative solver on small grids.
//
// Dense matrix K of influence coefficients, and the primal-dual active set method: on the nodes A in contact,
//   K_AA p_A = δ − h_A,  and Σ p_A = P if the force is prescribed (then δ is unknown too),
// by Cholesky factors; A loses the nodes with p < 0 and gains those with h + K p < δ, until it stands still. Then
// every condition of contact holds to the round-off of one linear solve.
//
// Lengths in metres, pressures in units of E*. Periodic K: mean displacement zero.
#pragma once

#include <vector>

#include "base/grid.h"
#include "contact/problem.h"

namespace brinell::support {

/// What each node sees of the others: response[j·nx + i] is the displacement at the offset (i, j), [m] for p = E*.
/// Free: 0 <= i < nx by symmetry |i|. Periodic: a sum over all waves of the grid, in long double.
std::vector<double> response_of(const Grid& grid, Boundary boundary);

/// Displacement [m] of p by the plain sum over its non-zero entries, in long double.
std::vector<double> displacement_of(const Grid& grid, const std::vector<double>& response, Boundary boundary,
                                    const std::vector<double>& p);

struct DirectContact {
  bool solved = false;  // the set of nodes in contact stands still
  double approach = 0;
  double total = 0;  // Σ p
  std::vector<double> pressure;
};

DirectContact direct_contact(const Grid& grid, Boundary boundary, const std::vector<double>& gap,
                             contact::Drive drive, double target);

/// The certificate of p by its definition, from displacement_of.
contact::Certificate certificate_by_sums(const Grid& grid, Boundary boundary, const std::vector<double>& gap,
                                         const std::vector<double>& p, double approach, contact::Drive drive,
                                         double target);

}  // namespace brinell::support
