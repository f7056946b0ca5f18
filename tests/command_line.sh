#!/usr/bin/env bash
# Runs the program as a user would: what is right must work, and what is wrong must end with status 2 and one line on
# stderr, and leave nothing behind. Usage: command_line.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

printf "$square"'usemtl leaf\nf 1 2 3 4\nf 1 1 2\nusemtl bark\nf 1 2 3\n' >flat.obj
printf "$square"'usemtl bark\nf 1 2 3 4\n' >wood.obj
printf 'v nan 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\n' >nan.obj
printf 'v inf 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\n' >inf.obj
printf "$square"'usemtl leaf\nf 1 2 9\n' >range.obj
printf "$square"'usemtl leaf\nf 1 1 2\n' >only_flat.obj
printf "$square"'usemtl whatever\nf 1 2 3 4\n' >unknown.obj
: >empty.obj
: >empty.vdb
seq 1 700 | tr '0-9\n' '\000-\011\377' >garbage.obj
cp garbage.obj garbage.vdb
mkdir folder folder.toml
printf '[sun]\nzenit_deg = 3\n' >unknown_key.toml
printf '[sun]\nzenith_deg = "high"\n' >wrong_type.toml
printf '[sun]\nzenith_deg = 195\n' >out_of_range.toml
printf '[sun\n' >broken.toml
printf '[tree]\nfile = "none.obj"\n' >missing_mesh.toml

for command in validate trace voxelize plant; do
  out=(); [ $command = voxelize ] && out=(-o out.vdb); [ $command = plant ] && out=(-o out.obj)
  refuses "missing.obj" $command missing.obj "${out[@]}"
  refuses "empty.obj" $command empty.obj "${out[@]}"
  refuses "nan.obj" $command nan.obj "${out[@]}"
  refuses "inf.obj" $command inf.obj "${out[@]}"
  refuses "range.obj" $command range.obj "${out[@]}"
  refuses "only_flat.obj" $command only_flat.obj "${out[@]}"
  refuses "wood.obj" $command wood.obj "${out[@]}"
  refuses "unknown.obj" $command unknown.obj "${out[@]}"
  refuses "garbage.obj" $command garbage.obj "${out[@]}"
done
refuses "folder" plant folder/x.obj
refuses "--frobnicate" validate --frobnicate
refuses "frobnicate" frobnicate
refuses "--model" view leaf.obj --model none
refuses "--window" view leaf.obj --window 0 100
refuses "missing.txt" view leaf.obj --script missing.txt
refuses "garbage.obj:1" view leaf.obj --script garbage.obj
refuses "missing.obj" view missing.obj --offscreen --frames 1
refuses "--albedo" validate leaf.obj --albedo 1.5
refuses "--albedo" trace leaf.obj --albedo -0.1
refuses "--albedo" render leaf.obj -o x.png --albedo nan
printf '[tree]\nfile = "leaf.obj"\n[stand]\nkind = "positions"\npositions = [%s]\n' \
  "$(seq 65 | awk '{ printf "[%g, 0],", $1 / 1000 }')" >crowd.toml
for command in "validate" "render -o x.png"; do refuses "= 65: must be at most 64" $command crowd.toml; done
refuses "nowhere" voxelize leaf.obj -o nowhere/x.vdb
refuses "nowhere" render leaf.obj -o nowhere/x.png
refuses "folder" plant leaf.obj -o folder
refuses ".jpg" render leaf.obj -o x.jpg
refuses "--preview with --model sppg" render leaf.obj -o x.png --preview
refuses "empty.vdb" voxelize empty.vdb
refuses "garbage.vdb" voxelize garbage.vdb
refuses "missing.vdb" voxelize missing.vdb
refuses "--cell-size" voxelize leaf.obj -o x.vdb --cell-size 0
refuses "cell" voxelize leaf.obj -o x.vdb --cell-size 1e-6
refuses "/proc/x.vdb: cannot be written: No such file" voxelize leaf.obj -o /proc/x.vdb
refuses "garbage.vdb: holds grids and no leaves" render garbage.vdb -o x.png
refuses "size of the tree" validate leaf.obj --scale 1e-5
refuses "unknown_key.toml:2" trace unknown_key.toml
refuses "wrong_type.toml:2" trace wrong_type.toml
refuses "out_of_range.toml:2" trace out_of_range.toml
refuses "broken.toml:1" trace broken.toml
refuses "none.obj" trace missing_mesh.toml
refuses "missing.toml" trace missing.toml
refuses "no-such-scene" trace no-such-scene
refuses ".csv" trace leaf.obj -o x.png
refuses ".vdb" voxelize leaf.obj -o x.txt
refuses ".jpg" trace leaf.obj --picture x.jpg
refuses "folder" trace folder.toml
{ printf '['; printf 'a.%.0s' {1..50000}; printf 'b]\n'; } >deep.toml
refuses "deep.toml:1" trace deep.toml
printf '[tree]\nfile = "leaf.obj"\n[ground]\nalbedo = 0.2\n' >ground.toml
printf '[tree]\nfile = "leaf.obj"\n[stand]\nkind = "positions"\npositions = [[0, 0, 45]]\n' >rotated.toml
refuses "ground albedo" validate ground.toml
does "wrote" validate rotated.toml --paths 1000 --no-pictures -o report
printf '[[tree]]\nfile = "leaf.obj"\n[[tree]]\nfile = "leaf.obj"\nname = "dark"\nleaf_reflectance = 0.1\n' >kinds.toml
refuses "kinds.toml: [stand] has no place for a tree of kind \"dark\"" trace kinds.toml
printf '[stand]\nkind = "positions"\npositions = [[0, 0, "dark"], [3, 0, "leaf"]]\n' >>kinds.toml
does "2 leaves" validate kinds.toml --paths 1000 --no-pictures -o report
does "wrote kinds.png" render kinds.toml --size 16 16 -o kinds.png
refuses "with --stand" voxelize kinds.toml
refuses "without --stand" voxelize leaf.obj --period 3 3
refuses "in [1e-6, 1e6] m" voxelize leaf.obj --stand --period 1e-9 3
refuses "at most a side of the period" voxelize leaf.obj --stand --period 2 3 --cell-size 2.5
refuses "in [2e-5, 1e6] m" voxelize leaf.obj --cell-size 1e-5 -o x.vdb
does "wrote rotated.png" render rotated.toml --size 16 16 -o rotated.png
refuses "period" validate leaf.obj --period 0.01 0.01
refuses "--only-picture" trace leaf.obj --only-picture -o x.csv
refuses "/dev/null" voxelize leaf.obj -o /dev/null
for ending in vdb nvdb; do  # files of some 100 KB and more, where only 20 KB may be written: as on a full disk
  (trap '' XFSZ; ulimit -f 20; failures=0; refuses "cannot be written" voxelize leaf.obj -o full.$ending --cell-size 0.1
   [ $failures -eq 0 ]) || failures=$((failures + 1))
done
refuses "albedo" trace leaf.obj --albedo 1.0000001

refuses "0 or in [0.1, 150] degrees" trace --field-of-view 0.05
refuses "0 or in [0.1, 150] degrees" trace --field-of-view 151
refuses "--tone-map" trace --tone-map sepia
refuses "--place" trace --date 2003-10-17T12:30
refuses "--date" trace --place 40 -105
refuses "excludes" trace --date 2003-10-17T12:30 --place 40 -105 --sun-zenith 3
refuses "must be a day from 1900 to 2100" trace --date 2003-02-29T12:30 --place 40 -105
refuses "must be a date and a time" trace --date 2003-02-28 --place 40 -105
refuses "latitude = 91: must be in [-90, 90] degrees" trace --date 2003-10-17T12:30 --place 91 0
refuses "even" validate cherry --directions 7 -o dirs
refuses "--frobnicate" tables --frobnicate


does "COMMAND" --help
does "zenith_deg" --help scene
does "--exposure" --help render
does "--layers" --help render
does "1 leaf (2 triangles)" validate leaf.obj --paths 1e3 --no-pictures --cells 1e1 --seed 2e0 -o report
refuses "--cells" validate leaf.obj --cells 1.5e0
does "at most 1024 trees" --help scene
does "Sunfleck" --version
for command in validate slab tables plant voxelize trace merge render bench; do does "--json" $command --help; done
does "1 leaf and 0 wood" plant flat.obj
does "cells" voxelize leaf.obj -o leaf.vdb --cell-size 0.1
does "cells" voxelize leaf.vdb
does "one period of 2 m x 3 m" voxelize leaf.obj --stand --period 2 3 -o stand.vdb --cell-size 0.1
refuses "--stand" voxelize leaf.vdb --stand
refuses "--leaf: must be for a mesh file" voxelize cherry --leaf 'x*'
refuses "--cell-size" voxelize leaf.vdb --cell-size 0.1
does "transmittance_blue" voxelize kinds.toml --stand --cell-size 0.1 -o kinds.vdb
does "mean_reflectance" voxelize kinds.vdb --json
does "reflectance_red" voxelize leaf.obj --optics --cell-size 0.1 -o leaf_optics.nvdb
"$program" trace kinds.toml --paths 1000 -o leaves.csv >/dev/null && grep -q "^dark,0," leaves.csv || fail "trace: no kind"
# What other programs are told.
vdb_print -l stand.vdb >printed || fail "vdb_print: status $?"
for line in "Name: density" "Name: normal_yz" "class: fog volume" "creator: Sunfleck .*, commit" "leaf_area_m2: " \
    "lai: " "length_unit: m" "unit_density: 1/m" "unit_normal_xy: 1" "period_x_m: 2" "period_y_m: 3" \
    "projection_model: .*G(s)" "source: 1 x leaf.obj" "source_hash: [0-9a-f-]\{36\}"; do
  grep -q "$line" printed || fail "vdb_print: no \"$line\""
done
does "normal_xx" voxelize leaf.obj -o leaf.nvdb --cell-size 0.1
does '"name": "density"' voxelize leaf.vdb --json
does '"absorbed_leaves"' trace leaf.obj --paths 1000 --json
does '"models"' --json leaf.obj --paths 1000 --no-pictures -o report
does "wrote" validate leaf.obj --paths 1000 --no-pictures -o report
does "sky light" validate leaf.obj --paths 1000 --no-pictures -o report --stats
does "picture 8 x 6" trace leaf.obj --only-picture --samples 4 --size 8 6 --date 2003-10-17T12:30:30-07:00 --place 39.74 -105.18 --field-of-view 90 --picture p.png --tone-map filmic --quiet
printf 'v 0 0 0\nv 0 1 0\nv 0 1 1\nusemtl leaf\nf 1 2 3\n' >upright.obj  # the sun does not see it
# A map may be more than OpenGL reads at once: refused, with the option that says how large it is.
printf "$square"'v 0 0 2\nv 1 0 2\nv 1 1 2\nv 0 1 2\nusemtl leaf\nf 1 2 3 4\nf 5 6 7 8\n' >two.obj
"$program" render two.obj --map 4096 --size 8 8 -o large.png >/dev/null 2>stderr.txt
case $? in
  0) ;;
  2) grep -q -- "--map = 4096: the light's opacity map takes" stderr.txt || fail "--map: $(cat stderr.txt)" ;;
  *) fail "render --map 4096: $(cat stderr.txt)" ;;
esac
does '"rms_noise": null' validate upright.obj --paths 1000 --no-pictures -o report --json
does "nothing to compare with" validate upright.obj --paths 1000 --no-pictures -o report
[ -s report/report.html ] && [ -s report/report.json ] || fail "validate: no report"

# The process that reads a .vdb file, and its limits.
: >read.vdb
"$program" read-grid leaf.vdb read.vdb 2000000000 60 || fail "read-grid: status $?"
does "leaf area" voxelize read.vdb
"$program" read-grid leaf.vdb read.vdb 1000 60 2>/dev/null && fail "read-grid: more than 1000 bytes"
"$program" --help | grep -q read-grid && fail "read-grid is no command of the user's"

head -c "$(($(stat -c %s leaf.vdb) / 2))" leaf.vdb >truncated.vdb
refuses "truncated.vdb" voxelize truncated.vdb

conclude
