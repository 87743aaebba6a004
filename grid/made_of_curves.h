// SPDX-License-Identifier: MIT
#pragma once
// What was made of each curve of a scene, kept for the next scene: a curve that is the same to the
// last bit, whatever its place among the others, is not made anew.
#include <memory>
#include <vector>

#include <drumhead/grid/curve.h>

namespace drumhead::grid {

template <class Made>
class MadeOfCurves {
 public:
  using Pointers = std::vector<std::shared_ptr<const Made>>;

  /// make(curve) for every curve that was not in the scene before. Where that throws, the scene
  /// before is still kept.
  template <class Make>
  Pointers of(const std::vector<CurvePair>& curves, Make&& make) {
    std::vector<Entry> entries;
    Pointers made;
    entries.reserve(curves.size());
    std::size_t next = 0;  // most curves follow the one that they followed
    for (const CurvePair& curve : curves) {
      const std::size_t k = find(curve, next);
      if (k < entries_.size()) {
        entries.push_back(entries_[k]);
        next = k + 1;
      } else {
        entries.push_back({curve, std::make_shared<const Made>(make(curve))});
        ++next;
      }
      made.push_back(entries.back().made);
    }
    entries_ = std::move(entries);
    return made;
  }

 private:
  struct Entry {
    CurvePair curve;
    std::shared_ptr<const Made> made;
  };
  /// From `next` on and round; entries_.size() for none.
  std::size_t find(const CurvePair& curve, std::size_t next) const {
    for (std::size_t n = 0; n < entries_.size(); ++n)
      if (const std::size_t k = (next + n) % entries_.size(); entries_[k].curve == curve) return k;
    return entries_.size();
  }

  std::vector<Entry> entries_;
};

}  // namespace drumhead::grid
