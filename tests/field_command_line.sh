#!/usr/bin/env bash
# Runs the program's light field as a user would on trees and light at the edge of what there is: what is wrong must end
# with status 2 and one line on stderr, and leave nothing behind. Usage: field_command_line.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

# square SIDE HEIGHT [TIMES]: level leaves, one on the other.
square() {
  awk -v h="$(awk "BEGIN { printf \"%.9g\", $1 / 2 }")" -v z="$2" -v times="${3:-1}" 'BEGIN {
    print "usemtl leaf"
    for (i = 0; i < times; ++i) {
      if (i > 0) z += 1e-6  # leaves at one and the same place would be one
      printf "v %.9g %.9g %.9g\nv %.9g %.9g %.9g\nv %.9g %.9g %.9g\nv %.9g %.9g %.9g\n", -h, -h, z, h, -h, z, h, h, z, -h, h, z
      printf "f %d %d %d %d\n", 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 4
    } }'
}
square 0.1 1 >leaf.obj
square 1e-6 1 >speck.obj
square 1e6 1 >country.obj
square 0.1 1 3000 >heap.obj
square 0 1 >flat.obj
printf 'v 0 0 1\nv 1 0 1\nv 1 1 1\nusemtl bark\nf 1 2 3\n' >wood.obj
printf 'v nan 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\n' >nan.obj
printf 'v inf 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\n' >inf.obj
printf 'v %s\n' "0 0 0" "1 0 0" "1 1 0" "0 1 0" "0 0 1" "1 0 1" "1 1 1" "0 1 1" >box.obj
printf 'usemtl leaf\nf 1 2 3 4\nf 5 8 7 6\nf 1 5 6 2\nf 2 6 7 3\nf 3 7 8 4\nf 4 8 5 1\n' >>box.obj
printf '[tree]\nfile = "box.obj"\n[leaf]\nreflectance = 1.0\ntransmittance = 0.0\n' >white_box.toml
printf '[tree]\nfile = "leaf.obj"\n[sun]\nirradiance = 0.0\n' >dark.toml

judged=(--paths 1000 --no-pictures --quiet -o report)
drawn=(--model field --size 16 12 --quiet -o x.png)
both() { # WHAT_THE_MESSAGE_MUST_HOLD SCENE OPTIONS...
  refuses "$1" validate "${@:2}" "${judged[@]}"
  refuses "$1" render "${@:2}" "${drawn[@]}"
}

both "wood.obj" wood.obj
both "nan.obj" nan.obj
both "inf.obj" inf.obj
both "flat.obj" flat.obj
both "size of the tree [m] = 1e-06" speck.obj
both "country.obj: vertex 1 x = -5e+05" country.obj
both "memory for the leaf crossings on the lines of an opacity map" heap.obj
both "no steady state" white_box.toml
both "at least 1/8 of the tree's width" leaf.obj --period 1e-4 1e-4
refuses "above the horizon" validate leaf.obj --sun-zenith 90 "${judged[@]}"
refuses "above the horizon" validate leaf.obj --sun-zenith 130 "${judged[@]}"

# What is no mistake: white leaves where light can leave, a sun that has set, light of no power.
does "FIELD" validate leaf.obj --albedo 1 "${judged[@]}"
for options in "leaf.obj --albedo 1" "leaf.obj --sun-zenith 90" "leaf.obj --sun-zenith 130" "dark.toml"; do
  # shellcheck disable=SC2086
  does "" render $options "${drawn[@]}"
done
conclude
