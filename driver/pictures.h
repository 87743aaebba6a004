// SPDX-License-Identifier: MIT
#pragma once
// All pictures of a run. The warped picture is made once, in bands of rows that go to its file and
// to the pictures that show it; beside the source picture (4 bytes a value, and a third more where
// the warp folds or compresses strongly) and the plate, if there is one, a band is held, and for
// one picture at a time that lines are drawn on, 4 bytes a pixel.
#include <drumhead/kernels/resample.h>
#include <drumhead/multigrid/warp.h>
#include <filesystem>
#include <string>
#include <vector>

#include "frame.h"
#include "image.h"
#include "progress.h"
#include "svg_curves.h"

namespace drumhead::driver {

/// Where to write; empty: not asked for.
struct PictureFiles {
  std::filesystem::path output, overlay, checkerboard, jacobian;
};

/// PNG files, at most 1024 pixels wide and high.
struct PagePictures {
  std::string before, after, overlay, jacobian;
};

struct PictureTask {
  const Image& picture;
  const multigrid::Solution& solution;
  const std::vector<SvgCurve>& curves;
  Frame frame;
  kernels::Border border = kernels::Border::clamp;
  int threads = 0;
  const Image* plate = nullptr;  ///< under the picture and the warped one
};

/// Writes what `files` names and, where `page` is not null, makes its pictures. Adds to
/// seconds.render and seconds.write. Throws std::runtime_error naming the file.
void make_pictures(const PictureTask& task, const PictureFiles& files, PagePictures* page,
                   Progress& progress, Seconds& seconds);

}  // namespace drumhead::driver
