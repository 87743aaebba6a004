// SPDX-License-Identifier: MIT
#include "samplers.h"

#include <OpenImageIO/imagebuf.h>
#include <OpenImageIO/imagebufalgo.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#if DRUMHEAD_BENCH_OPENCV
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#endif
#if DRUMHEAD_BENCH_VIPS
#include <vips/vips.h>
#endif

namespace drumhead::bench {
namespace {

using Positions = std::vector<kernels::Position>;

/// The map as a library takes it, kept until another map comes.
class KeptMap {
 public:
  template <class Code>
  std::vector<float>& of(const Positions& source, const Code& code) {
    if (source.data() == from_) return values_;
    from_ = source.data();
    values_.clear();
    for (const kernels::Position& p : source) {
      const auto [r, g] = code(p);
      values_.push_back(float(r));
      values_.push_back(float(g));
    }
    return values_;
  }

 private:
  const kernels::Position* from_ = nullptr;
  std::vector<float> values_;
};

Sampler st_warp(const Pixels& picture, const std::string& filter) {
  const auto map = std::make_shared<KeptMap>();
  return {
      "OpenImageIO st_warp", filter, [&picture, map, filter](const Positions& source, Pixels& out) {
        const double w = picture.width, h = picture.height;
        auto& st =
            map->of(source, [&](kernels::Position p) { return std::pair(p.x / w, p.y / h); });
        const auto window = [](int width, int height, int channels, void* data) {
          return OIIO::ImageBuf(OIIO::ImageSpec(width, height, channels, OIIO::TypeDesc::FLOAT),
                                data);
        };
        const OIIO::ImageBuf from = window(picture.width, picture.height, picture.channels,
                                           const_cast<float*>(picture.data.data()));
        const OIIO::ImageBuf by = window(out.width, out.height, 2, st.data());
        OIIO::ImageBuf to = window(out.width, out.height, out.channels, out.data.data());
        if (!OIIO::ImageBufAlgo::st_warp(to, from, by, filter, 0.0f, 0, 1, false, false, {}, 1)) {
          throw std::runtime_error("st_warp: " + to.geterror());
        }
      }};
}

#if DRUMHEAD_BENCH_OPENCV
Sampler remap(const Pixels& picture, const std::string& filter, int flag) {
  cv::setNumThreads(1);
  const auto map = std::make_shared<KeptMap>();
  return {"OpenCV remap", filter, [&picture, map, flag](const Positions& source, Pixels& out) {
            auto& xy = map->of(source,
                               [](kernels::Position p) { return std::pair(p.x - 0.5, p.y - 0.5); });
            const int type = CV_32FC(picture.channels);
            const cv::Mat from(picture.height, picture.width, type,
                               const_cast<float*>(picture.data.data()));
            const cv::Mat by(out.height, out.width, CV_32FC2, xy.data());
            cv::Mat to(out.height, out.width, type, out.data.data());
            cv::remap(from, to, by, cv::noArray(), flag, cv::BORDER_REPLICATE);
          }};
}
#endif

#if DRUMHEAD_BENCH_VIPS
Sampler mapim(const Pixels& picture, const std::string& filter) {
  if (VIPS_INIT("bench") != 0) throw std::runtime_error("libvips does not start");
  vips_concurrency_set(1);
  vips_cache_set_max(0);  // it would hand out the last result again
  const auto map = std::make_shared<KeptMap>();
  return {
      "libvips mapim", filter, [&picture, map, filter](const Positions& source, Pixels& out) {
        auto& xy =
            map->of(source, [](kernels::Position p) { return std::pair(p.x - 0.5, p.y - 0.5); });
        const auto image = [](const float* data, int width, int height, int bands) {
          const std::size_t bytes =
              sizeof(float) * std::size_t(width) * std::size_t(height) * std::size_t(bands);
          return vips_image_new_from_memory(data, bytes, width, height, bands, VIPS_FORMAT_FLOAT);
        };
        VipsImage* from =
            image(picture.data.data(), picture.width, picture.height, picture.channels);
        VipsImage* by = image(xy.data(), out.width, out.height, 2);
        VipsInterpolate* interpolate = vips_interpolate_new(filter.c_str());
        VipsImage* to = nullptr;
        std::size_t bytes = 0;
        void* pixels = nullptr;
        if (vips_mapim(from, &to, by, "interpolate", interpolate, nullptr) == 0) {
          pixels = vips_image_write_to_memory(to, &bytes);
        }
        if (!pixels) throw std::runtime_error(std::string("mapim: ") + vips_error_buffer());
        std::memcpy(out.data.data(), pixels, bytes);
        g_free(pixels);
        for (void* object : {static_cast<void*>(to), static_cast<void*>(interpolate),
                             static_cast<void*>(by), static_cast<void*>(from)}) {
          g_object_unref(object);
        }
      }};
}
#endif

}  // namespace

std::vector<Sampler> samplers(const Pixels& picture) {
  std::vector<Sampler> all = {st_warp(picture, "triangle"), st_warp(picture, "catmull-rom"),
                              st_warp(picture, "lanczos3")};
#if DRUMHEAD_BENCH_OPENCV
  all.push_back(remap(picture, "linear", cv::INTER_LINEAR));
  all.push_back(remap(picture, "cubic", cv::INTER_CUBIC));
  all.push_back(remap(picture, "lanczos4", cv::INTER_LANCZOS4));
#endif
#if DRUMHEAD_BENCH_VIPS
  all.push_back(mapim(picture, "bilinear"));
  all.push_back(mapim(picture, "bicubic"));
  all.push_back(mapim(picture, "lbb"));
#endif
  return all;
}

}  // namespace drumhead::bench
