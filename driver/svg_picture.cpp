// SPDX-License-Identifier: MIT
#include "svg_picture.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "atomic_file.h"
#include "svg_curves.h"
#include "svg_text.h"

namespace drumhead::driver {
namespace {

namespace fs = std::filesystem;

constexpr int kLeastSide = 1024, kGreatestSide = 32767;  // cairo's, and so rsvg-convert's, limit

struct Size {
  int width = 0, height = 0;
};

Size size_of(const SvgDocument& document, const SvgView& view) {
  const auto pixels = [&](const char* name) {
    const std::string_view text = document.root().attribute(name).value();
    return text.ends_with('%') ? 0.0 : svg_length(text, 0.0).value_or(0.0);
  };
  double width = pixels("width"), height = pixels("height");
  if (width <= 0) width = height > 0 ? height * view.width / view.height : view.width;
  height = width * view.height / view.width;
  const double scale = std::max(1.0, kLeastSide / std::max(width, height));
  if (std::max(width, height) * scale > kGreatestSide) {
    throw std::invalid_argument(document.file().string() + ": its longer side must be at most " +
                                std::to_string(kGreatestSide) + " pixels");
  }
  return {std::max(1, int(std::lround(width * scale))),
          std::max(1, int(std::lround(height * scale)))};
}

/// Inline style is the strongest but for !important, which stylesheets of drawings do not use.
void hide(pugi::xml_node element) {
  pugi::xml_attribute style = element.attribute("style");
  if (!style) style = element.append_attribute("style");
  style.set_value((std::string(style.value()) + ";display:none").c_str());
}

void set(pugi::xml_node element, const char* name, const std::string& value) {
  element.remove_attribute(name);
  element.append_attribute(name) = value.c_str();
}

/// Pictures beside the drawing are only found from its own folder.
bool links_to_files(pugi::xml_node root) {
  const auto outside = [](std::string_view href) {
    return !href.empty() && !href.starts_with('#') && !href.starts_with("data:");
  };
  return bool(root.find_node([&](pugi::xml_node node) {
    const bool shows = kind(node) == "image" || kind(node) == "feImage" || kind(node) == "use";
    return shows && (outside(node.attribute("href").value()) ||
                     outside(node.attribute("xlink:href").value()));
  }));
}

std::string first_line(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

/// Runs a program with its output going to `log`. Throws std::runtime_error if it cannot be
/// started.
int run(std::vector<std::string> words, const fs::path& log) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_TRUNC, 0);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error) {
    throw std::runtime_error(words[0] +
                             " (Debian package librsvg2-bin), which rasterises SVG "
                             "pictures, cannot be run: " +
                             std::strerror(error));
  }
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

Image rasterise(const fs::path& file, const ReadOptions& options) {
  SvgDocument document(file);
  const auto view = document.view();
  if (!view) {
    throw std::invalid_argument(file.string() +
                                ": a drawing that is rasterised needs a viewBox, or "
                                "width and height");
  }
  const Size size = size_of(document, *view);
  for (const pugi::xml_node element : curve_elements(document)) hide(element);
  char box[160];
  std::snprintf(box, sizeof box, "%.17g %.17g %.17g %.17g", view->x, view->y, view->width,
                view->height);
  const std::string width = std::to_string(size.width), height = std::to_string(size.height);
  set(document.root(), "viewBox", box);
  set(document.root(), "width", width);
  set(document.root(), "height", height);
  set(document.root(), "preserveAspectRatio", "none");
  std::error_code error;
  const fs::path scratch = fs::temp_directory_path(error);
  if (error) throw std::runtime_error("TMPDIR names no folder, and rasterising needs one");
  const bool beside = links_to_files(document.root());
  // None of the three is committed: they go when this function ends.
  const AtomicFile copy((beside ? file.parent_path() : scratch) / "drumhead-drawing.svg");
  const AtomicFile raster(scratch / "drumhead-raster.png"), log(scratch / "drumhead-rsvg.log");
  document.save(copy.temporary());
  const int status =
      run({"rsvg-convert", "--unlimited", "--format", "png", "--width", width, "--height", height,
           "--output", raster.temporary().string(), copy.temporary().string()},
          log.temporary());
  if (status != 0) {
    throw std::invalid_argument(file.string() + ": rsvg-convert: " + first_line(log.temporary()));
  }
  return read_image(raster.temporary(), options);
}

}  // namespace drumhead::driver
