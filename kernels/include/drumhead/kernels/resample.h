// SPDX-License-Identifier: MIT
#pragma once
// A picture through the deformed lattice (Setaluri et al. 2014 only say "render"; everything here
// is ours).
//
// Geometry. Node (i, j) of the lattice rests at origin + cell_px (i, j) and lies at rest + (u, v)
// after the warp; inside a cell both are bilinear. An output pixel takes its colour from the rest
// position of the point that came to lie under its centre: the cell's bilinear map is inverted
// exactly (a quadratic, both roots; no iteration). Cells that curves cut are given as triangles
// instead, each affine, so that the kink along a curve is rendered where it is. Coordinates are
// continuous picture pixels: pixel (a, b) is centred at (a+½, b+½).
//
// Folds. Where several points lie under a pixel, one whose J = det ∂(warped)/∂(rest) is positive
// wins over the others; among equals the cell of the later row, and in a row the later column. The
// rule does not see tiles or threads. Points that no cell covers, outside the fixed boundary, are
// the identity.
//
// Filter. With Σ the singular values of ∂(source)/∂(output) and U its left singular vectors, a
// source pixel at distance d from the point weighs c(a) c(b), (a, b) = S⁻¹ d, S = U f(Σ) Uᵀ, c
// Catmull–Rom; weights are divided by their sum. f(σ) = 1 up to a compression of σ = 1.125, σ from
// 1.25 on, a line between. So there is one formula, continuous in the Jacobian: plain bicubic
// interpolation where nothing is compressed, under rotation too, and the output pixel's own cubic
// prefilter where it is, anisotropic in between. Catmull–Rom instead of a Gaussian ellipse because
// it interpolates, sums to 1 and is sharper (0.94 of the contrast at half the output's band limit;
// a Gaussian of σ = ½ pixel, 0.73). It overshoots a step by at most 7.5 % per direction; nothing
// is clamped, and values below 0 or above the picture's range (alpha too) are for the writer to
// clamp. Beyond f(σ2) = 2 detail the taps come from a pyramid, blended between levels: a pixel
// costs at most about 64 detail² anisotropy taps. Where the displacement is zero, or the same
// whole number of pixels, the source pixel is returned bit for bit.
//
// Sizes, strides, options and arrays outside the bounds named here throw std::invalid_argument,
// naming value and bound, before anything is written.
//
// Channels are interleaved and filtered alike: premultiply alpha and linearise before, undo it
// afterwards.
#include <cstddef>
#include <memory>

namespace drumhead::kernels {

/// Continuous picture pixels, x right, y down.
struct Position {
  double x = 0.0, y = 0.0;
};

/// A picture to read: channel c of pixel (a, b) is data[b·row_stride + a·channels + c].
struct ImageView {
  const float* data = nullptr;
  int width = 0, height = 0, channels = 0;  ///< each ≥ 1
  std::ptrdiff_t row_stride = 0;            ///< floats from row to row, ≥ width·channels
};

/// A picture to write. Its first pixel is pixel (left, top) of the source's frame, so that the
/// padded domain (negative left and top) or a band of rows can be asked for; bands joined equal the
/// whole, bit for bit.
struct ImageTarget {
  float* data = nullptr;
  int width = 0, height = 0, channels = 0;  ///< ≥ 0; channels as the source's
  std::ptrdiff_t row_stride = 0;            ///< floats from row to row, ≥ width·channels
  int left = 0, top = 0;
};

/// A triangle of a cell that is not bilinear: the warp is affine in it.
struct MapTriangle {
  Position rest[3];          ///< picture pixels, in the sense x → y: area > 0
  Position displacement[3];  ///< of these points
};

/// The cells that are made of triangles instead, sorted by row, then column: cells of row j are
/// [row_begin[j], row_begin[j+1]). Their triangles may reach beyond the cell's square and leave
/// parts of it to those of the next cells by less than a cell; together with the other cells they
/// cover the lattice once.
struct SplitCellsView {
  const int* row_begin = nullptr;  ///< ny + 1; null: there are none
  const int* column = nullptr;
  const int* triangle_begin = nullptr;  ///< one more than cells
  const MapTriangle* triangle = nullptr;

  /// Index of cell (i, j), −1 if it is bilinear.
  int find(int i, int j) const;
};

/// The deformed lattice: displacement of the point that rests at node (i, j) is
/// u, v[j·(nx+1) + i] in picture pixels. A cell or triangle with a corner that is not finite covers
/// nothing.
struct LatticeMapView {
  const double* u = nullptr;
  const double* v = nullptr;
  int nx = 0, ny = 0;    ///< cells, ≥ 1; nx·ny < 2³¹
  double cell_px = 1.0;  ///< > 0
  Position origin_px;    ///< rest position of node (0, 0)
  SplitCellsView split;
};

/// The backward map to write, at pixels (left … left+width−1, top … top+height−1) of the output. An
/// array that is null is left out; pixel (a, b) of the rectangle has index b·row_stride + a in
/// each.
struct BackwardMapTarget {
  Position* source = nullptr;  ///< source position under the pixel's centre
  float (*jacobian)[4] = nullptr;  ///< ∂x/∂a, ∂x/∂b, ∂y/∂a, ∂y/∂b: source (x, y) by output (a, b)
  signed char* side =
      nullptr;  ///< 1: J > 0; −1: only points with J ≤ 0 lie here; 0: outside, identity
  int width = 0, height = 0;
  std::ptrdiff_t row_stride = 0;  ///< pixels from row to row, ≥ width
  int left = 0, top = 0;
};

/// The forward map to write, at the centres of pixels (left … left+width−1, top … top+height−1) of
/// the source: pixel (a, b) of the rectangle has index b·row_stride + a.
struct ForwardMapTarget {
  Position* output = nullptr;  ///< where the warp takes the pixel's centre
  int width = 0, height = 0;
  std::ptrdiff_t row_stride = 0;  ///< pixels from row to row, ≥ width
  int left = 0, top = 0;
};

/// What lies beyond the source picture.
enum class Border {
  clamp,        ///< its edge pixels go on for ever
  mirror,       ///< reflected at its edges, the edge pixel twice
  transparent,  ///< zero in every channel
};

struct ResampleOptions {
  Border border = Border::clamp;
  /// Least footprint radius σ2, in pixels of the pyramid level that is sampled, 1…16. Twice as much
  /// takes up to four times the taps where the warp compresses by more than 2 detail. Error of the
  /// pyramid on a zone plate, PSNR: 1: 30…42 dB, 2: 53…67 dB, 4: 60…71 dB.
  double detail = 2.0;
  /// Greatest σ1/σ2 of a footprint, 1…64; σ2 is enlarged (blur across, never aliasing along) beyond
  /// it.
  double anisotropy = 16.0;
  int threads = 0;  ///< ≥ 0, OpenMP threads; 0: as OpenMP decides. Results do not depend on it.
};

/// Renders one picture through one lattice; both must outlive it. The constructor allocates the
/// boxes of 4 × 4 cells (3 bytes a cell) and, only if the lattice folds or compresses beyond 2
/// detail somewhere, the pyramid: a third of the picture. `render` allocates 0.2 MB a thread,
/// whatever the size of the picture. Both throw std::bad_alloc, and std::invalid_argument for bad
/// input.
class Resampler {
 public:
  Resampler(const ImageView& source, const LatticeMapView& map,
            const ResampleOptions& options = {});
  ~Resampler();
  Resampler(Resampler&&) noexcept;
  Resampler& operator=(Resampler&&) noexcept;

  /// Writes every pixel of `out`, which must not overlap the source. May be called from several
  /// threads at once.
  void render(const ImageTarget& out) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The backward map alone, by the same inversion and fold rule. Allocates as the constructor above
/// (without the pyramid) and `render` do.
void backward_map(const LatticeMapView& map, const BackwardMapTarget& out, int threads = 0);

/// Where the warp takes a rest position (the forward map): rest + displacement, bilinear in a cell
/// and affine in a triangle, inside the lattice, rest itself outside.
Position forward_position(const LatticeMapView& map, Position rest_px);

/// forward_position at every pixel's centre.
void forward_map(const LatticeMapView& map, const ForwardMapTarget& out, int threads = 0);

}  // namespace drumhead::kernels
