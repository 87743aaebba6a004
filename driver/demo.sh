#!/bin/sh
# From a fresh Debian 12 to warped pictures, as root or with sudo: installs the packages that are missing,
# builds the drumhead command, warps the scenes of driver/examples and prints where the results are.
#     sh driver/demo.sh                 all scenes
#     sh driver/demo.sh face sponge     only these
# Run again, it does only what is missing or out of date.
set -eu
cd "$(dirname "$0")/.."

sh tests/install.sh
cmake --preset release
cmake --build --preset release --target drumhead

drumhead=build/release/driver/drumhead
examples=driver/examples
results=build/demo
mkdir -p "$results"
[ $# -gt 0 ] || set -- $(cd "$examples" && ls -- *.toml | sed 's/\.toml$//' | sort)

# The picture before the warp: what stands still under the drawing, if anything, and the drawing.
before() {
  rsvg-convert --output "$results/$1-before.png" "$2.svg"
  plate=$(sed -n 's/^plate = "\(.*\)".*/\1/p' "$examples/$1.toml")
  [ -n "$plate" ] || return 0
  rsvg-convert --output "$results/plate.png" "$examples/$plate"
  oiiotool "$results/$1-before.png" "$results/plate.png" --ch R,G,B,A=1.0 --over \
    -o "$results/$1-before.png"
  rm "$results/plate.png"
}

for scene in "$@"; do
  drawing=$examples/$(sed -n 's/^picture = "\(.*\)\.svg".*/\1/p' "$examples/$scene.toml")
  for needed in "$drumhead" "$examples/$scene.toml" "$drawing"*.svg; do
    if [ ! -e "$results/$scene.png" ] || [ "$needed" -nt "$results/$scene.png" ]; then
      echo "Warping $examples/$scene.toml"
      before "$scene" "$drawing"
      # Exit code 1: not converged, and said so; its picture is there to be looked at all the same.
      "$drumhead" warp "$examples/$scene.toml" || [ $? = 1 ]
      break
    fi
  done
done

echo
for scene in "$@"; do
  for result in -before.png .png -overlay.png -checkerboard.png -jacobian.png .json .html; do
    [ ! -e "$results/$scene$result" ] || echo "$PWD/$results/$scene$result"
  done
done
