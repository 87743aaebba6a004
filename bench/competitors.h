// SPDX-License-Identifier: MIT
#pragma once
// Other ways to the same product: a plain loop, and the assembled matrix in Eigen and (where
// installed) PETSc. The matrix is the tests' oracle, so that our product is checked against it too.
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace drumhead::bench {

enum class Contender { plain_loop, eigen, petsc };

/// Those that were built.
std::vector<Contender> contenders();

struct Problem;
class Product;

class Competitor {
 public:
  Competitor(Contender which, int n);
  ~Competitor();
  Competitor(const Competitor&) = delete;
  Competitor& operator=(const Competitor&) = delete;

  std::string name() const;
  std::size_t nodes() const;
  void run() const;       ///< the competitor's product
  void run_ours() const;  ///< the kernels' product of the same vector
  /// Both agree to rounding.
  bool right() const;

 private:
  std::unique_ptr<Problem> problem_;
  std::unique_ptr<Product> product_;
};

}  // namespace drumhead::bench
