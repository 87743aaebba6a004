#!/bin/sh
# Draws driver/examples/pictures again, which the READMEs show: 600 pixels wide.
#     sh driver/examples/pictures.sh                 all scenes
#     sh driver/examples/pictures.sh face sponge     only these
# Wants the Debian package optipng beside those of driver/demo.sh, which it runs first.
set -eu
cd "$(dirname "$0")/../.."
command -v optipng >/dev/null || {
  echo "driver/examples/pictures.sh: needs optipng (apt-get install optipng)" >&2
  exit 1
}
sh driver/demo.sh "$@"

examples=driver/examples
mkdir -p "$examples/pictures"
[ $# -gt 0 ] || set -- $(cd "$examples" && ls -- *.toml | sed 's/\.toml$//' | sort)
# small FROM TO
small() {
  oiiotool "$1" --ch R,G,B --resize:filter=lanczos3 600x0 -d uint8 -o "$2"
  optipng -quiet -o3 -strip all "$2"
}
for scene in "$@"; do
  # A scene that has no drawing of its own shares the picture before with the one whose it is.
  ! grep -q "^picture = \"$scene.svg\"" "$examples/$scene.toml" ||
    small "build/demo/$scene-before.png" "$examples/pictures/$scene-before.png"
  small "build/demo/$scene.png" "$examples/pictures/$scene-after.png"
  for more in checkerboard jacobian; do
    ! grep -q "pictures/$scene-$more.png" "$examples/README.md" ||
      small "build/demo/$scene-$more.png" "$examples/pictures/$scene-$more.png"
  done
  # Figure 6 has a thin-plate spline beside it.
  [ "$scene" != roundabout ] || {
    cmake --build --preset release --target warp_pictures
    build/release/bench/warp_pictures "$examples/$scene.toml" build/demo/rivals 16 >build/demo/rivals.json
    spline=build/demo/rivals/$scene-thin-plate-spline
    small "$spline.png" "$examples/pictures/$scene-spline.png"
    small "$spline-checkerboard.png" "$examples/pictures/$scene-spline-checkerboard.png"
  }
done
ls -l "$examples/pictures"
