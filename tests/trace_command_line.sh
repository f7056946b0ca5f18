#!/usr/bin/env bash
# Runs `sunfleck trace` and `merge` as a user would, and the other commands on what trace alone takes: what is right
# must work, and what is wrong must end with status 2 and one line on stderr, and leave nothing behind.
# Usage: trace_command_line.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

seq 1 700 | tr '0-9\n' '\000-\011\377' >garbage.obj

# Media: alone, in a period, with cells of a file, among trees; and leaves turned into one.
printf '[medium]\ndensity = 3\nangles = "planophile"\n[stand]\nkind = "periodic"\n' >slab.toml
printf '[medium]\nkind = "particles"\nextinction = 2\nasymmetry = 0.5\nbox = [0, 0, 0, 1, 1, 1]\n' >fog.toml
"$program" voxelize leaf.obj -o leaf.vdb --cell-size 0.25 >/dev/null || fail "voxelize for a medium"
printf '[tree]\nfile = "leaf.obj"\n[medium]\nfile = "leaf.vdb"\nscale = 0.5\n' >cells.toml
printf '[medium]\ndensity = 3\n[stand]\nkind = "grid"\n' >slab_in_a_grid.toml
printf '[medium]\ndensity = 3\n' >endless.toml
printf '[medium]\ndensity = 3\nfile = "leaf.vdb"\n' >twice.toml
printf '[medium]\ntop = 2\n' >neither.toml
printf '[medium]\ndensity = 3\nangles = "round"\n' >angles.toml
printf '[medium]\nkind = "particles"\nextinction = 3\nasymmetry = 1\n' >asymmetry.toml
printf '[medium]\nfile = "none.vdb"\n' >none.toml
printf '[medium]\nfile = "leaf.obj"\n' >not_a_grid.toml
does "absorbed by leaves" trace slab.toml --paths 1000 --brf 0:30:30 --brf-paths 100
does "absorbed by particles" trace fog.toml --paths 1000
does "absorbed_particles" trace fog.toml --paths 1000 --json
does "picture" trace fog.toml --only-picture --samples 1 --size 16 16
does "absorbed by leaves" trace cells.toml --paths 1000 --period 1 1
does "turbid in cells of 0.25 m" trace leaf.obj --paths 1000 --turbid 0.25 --brf 0:0:1 --brf-paths 100 --period 2 2
refuses "trace alone" render slab.toml -o x.png
refuses "trace alone" voxelize fog.toml
refuses "trace alone" validate cells.toml
refuses "without trees" trace slab_in_a_grid.toml
refuses "periodic" trace endless.toml
refuses "both file and density" trace twice.toml
refuses "neither file nor density" trace neither.toml
refuses "leaf angles" trace angles.toml
refuses "asymmetry" trace asymmetry.toml
refuses "none.vdb" trace none.toml
refuses "leaf.obj" trace not_a_grid.toml
refuses "with trees" trace slab.toml --turbid 0.1
refuses "--leaves" trace leaf.obj --turbid 0.1 -o x.csv
refuses "cell" trace leaf.obj --turbid 0.00002

# A trace killed at any moment goes on to what it would have told; parts make the whole.
shares() { grep -v seconds "$1"; }
run="trace leaf.obj --period 2 2 --paths 4e5 --json"
"$program" $run >whole.json || fail "$run"
kills=0  # in the middle: with some of the run in the file
for delay in 0.1 0.2 0.3 0.4 0.6 0.8 1.2; do
  timeout -s KILL $delay "$program" $run --checkpoint killed.trace --write-every 0 >/dev/null 2>&1
  [ $? -eq 137 ] && [ -e killed.trace ] && kills=$((kills + 1))
done 2>/dev/null
[ $kills -gt 0 ] || fail "no trace was killed in the middle"
"$program" $run --checkpoint killed.trace >killed.json || fail "$run --checkpoint"
[ "$(shares killed.json)" = "$(shares whole.json)" ] || fail "killed: $(diff killed.json whole.json)"
for part in 1 2 3; do "$program" $run --checkpoint part$part.trace --part $part/3 >/dev/null || fail "--part $part/3"; done
does "missing" merge part1.trace part3.trace -o two.trace
does "wrote three.trace" merge part2.trace two.trace -o three.trace
"$program" $run --checkpoint three.trace >merged.json || fail "merged"
[ "$(shares merged.json)" = "$(shares whole.json)" ] || fail "merged: $(diff merged.json whole.json)"
refuses "must not be in another file too" merge part1.trace two.trace -o x.trace
refuses "made with" trace leaf.obj --period 3 3 --paths 2e4 --checkpoint part1.trace
refuses "must be a trace file" merge garbage.obj -o x.trace
refuses "named with the extension .trace" trace leaf.obj --checkpoint x.txt
# Skies: traces tell of their share; only the field tells the irradiance of leaves under them; a checkpoint of another light is refused.
printf '[tree]\nfile = "leaf.obj"\n[stand]\nkind = "periodic"\nperiod = [2, 2]\n[sky]\nkind = "overcast"\n' >sky.toml
does "of the light, the sky's" trace sky.toml --paths 1000 --checkpoint sky.trace
does '"sky_share": 0.16666' trace sky.toml --paths 1000 --json
does "HDRF" trace sky.toml --only-brf --brf 0:60:60 --brf-paths 1000
sed -i 's/overcast/uniform/' sky.toml
refuses "sky.trace: made with light" trace sky.toml --paths 1000 --checkpoint sky.trace
does "FIELD" validate sky.toml --paths 1000 --no-pictures -o report  # alone: the others know no sky
printf '[tree]\nfile = "leaf.obj"\n[[sun]]\n[[sun]]\nzenith_deg = 30\n' >suns.toml
refuses "number of suns that shine = 2: must be 1 for Monte Carlo" trace suns.toml
sed -i 's/= 30/= 95/' suns.toml  # the second has set
does "FIELD" validate suns.toml --paths 1000 --no-pictures -o report
does "leaves" trace suns.toml --paths 1000
refuses "must come from the sun or from the sky" trace leaf.obj --sun-zenith 95 --paths 1000
refuses "above the horizon" validate leaf.obj --sun-zenith 95
does "wrote sky.exr" render sky.toml --size 16 16 --layers all -o sky.exr
refuses "only .exr keeps layers" render sky.toml --size 16 16 --layers all -o sky.png
refuses "--mes: must be for light from one direction" trace sky.toml --only-brf --brf 0:60:60 --mes x.mes
refuses "K/N" trace leaf.obj --checkpoint x.trace --part 4/3
refuses "relative error" trace leaf.obj --target 5x
refuses "--time" trace leaf.obj --time 5y
refuses "must be at most 1" trace leaf.obj --other-leaf 0.1 0.95
refuses "excludes" trace leaf.obj --all-bands --band 1
does "target_reached\": true" trace leaf.obj --period 2 2 --target 5% --json
"$program" trace leaf.obj --period 2 2 --paths 64 --target 0.01% --json 2>early.txt | grep -q 'target_reached": false' &&
  grep -q "not reached" early.txt || fail "--target: reached what it was not given the paths for: $(cat early.txt)"

# Cells: a flat leaf of 1 x 1 m that absorbs all is four cells of a quarter each.
does "wrote cells.csv" trace leaf.obj --paths 65536 --albedo 0 --cells cells.csv --cell 0.5
[ "$(head -1 cells.csv)" = "x_m,y_m,z_m,volume_m3,leaves,leaves_standard_error,leaves_per_m,wood,wood_standard_error,wood_per_m" ] &&
  [ "$(grep -c "^0\.[27]5,0\.[27]5,1\.25,0\.125,0\.25,0,2,0,0,0$" cells.csv)" -eq 4 ] || fail "--cells: $(cat cells.csv)"
does "wrote cells.vdb" trace leaf.obj --paths 1000 --all-bands --cells cells.vdb --cell 0.5
vdb_print -l cells.vdb | grep -q "Name: absorbed_leaves_blue_error" || fail "--cells: $(vdb_print -l cells.vdb)"
does "wrote cells.trace" trace leaf.obj --paths 1000 --cells cells.csv --checkpoint cells.trace
refuses "made with side of the cells = 0.25: must be 0.5" trace leaf.obj --paths 1000 --cells x.csv --cell 0.5 --checkpoint cells.trace
refuses ".csv or .vdb" trace leaf.obj --cells x.txt
refuses "number of cells" trace leaf.obj --cells x.csv --cell 1e-5
refuses "--cell" trace leaf.obj --cells x.csv --cell 0
refuses "--cells" trace leaf.obj --cell 1

# Spectra: of more bands than one path carries, over one another; a flat leaf that fills its period reflects its share.
printf 'name,leaf_reflectance,leaf_transmittance\n' >spectrum.csv
for band in $(seq 10 30); do echo "${band}0,0.$band,0.5"; done >>spectrum.csv
does "wrote found.csv" trace leaf.obj --period 1 1 --paths 1000 --spectrum spectrum.csv --spectrum-out found.csv
[ "$(wc -l <found.csv)" -eq 22 ] && awk -F, 'NR > 1 && ($2 - $1 / 1000) ^ 2 > 25 * $3 ^ 2 { exit 1 }' found.csv || fail "--spectrum-out: $(cat found.csv)"
does '"name": "300"' trace leaf.obj --period 1 1 --paths 1000 --spectrum spectrum.csv --json
printf 'name,leaf_reflectance,leaf_transmittance\na,0.1,0.2\nb,1.5,0\n' >bright.csv
printf 'name,leaf_reflectance,leaf_transmittance\na,0.6,0.5\n' >sum.csv
printf 'name,leaf_reflectance,leaf_transmittance,wood_reflectance\na,0.6,0.3,x\n' >letter.csv
printf 'name,leaf_reflectance,leaf_transmittance\na,0.6,0.3\na,0.1,0.1\n' >twice.csv
printf 'name,leaf_reflectance,leaf_transmittance\n' >no_band.csv
printf 'wavelength,r,t\n1,2,3\n' >header.csv
refuses "bright.csv:3: leaf_reflectance: 1.5: must be in [0, 1]" trace leaf.obj --spectrum bright.csv
refuses "sum.csv:2: leaf_transmittance" trace leaf.obj --spectrum sum.csv
refuses 'letter.csv:2: wood_reflectance: "x": must be a number' trace leaf.obj --spectrum letter.csv
refuses "twice.csv:3: name" trace leaf.obj --spectrum twice.csv
refuses "no_band.csv: must have at least one band" trace leaf.obj --spectrum no_band.csv
refuses "header.csv:1" trace leaf.obj --spectrum header.csv
refuses "missing.csv" trace leaf.obj --spectrum missing.csv
refuses "excludes" trace leaf.obj --spectrum spectrum.csv --all-bands
refuses "--spectrum" trace leaf.obj --spectrum-out x.csv

# Reflectance factors: of a flat leaf of reflectance 1/2 that fills its period, 1/2 in all directions.
does "hemisphere" trace leaf.obj --period 1 1 --paths 1000 --brf -60:60:30 --brf-paths 1000 --sun-zenith 30 --albedo 1 \
  --brf-csv brf.csv --mes brf.mes
[ "$(wc -l <brf.csv)" -eq 6 ] && grep -q "^-60,0,0\.4999999[0-9]*,0,0\.4999999[0-9]*,0,0,0,0,0,0,0$" brf.csv || fail "--brf-csv: $(cat brf.csv)"
[ "$(head -1 brf.mes)" = "5	5	-1.000000" ] || fail "--mes: $(head -1 brf.mes)"
grep -q "^0.523599	1.047198	0.000000	0.500000	0.000000$" brf.mes || fail "--mes: $(cat brf.mes)"
grep -q "^0.523599	1.047198	3.141593	0.500000	0.000000$" brf.mes || fail "--mes: $(cat brf.mes)"
printf 'zenith_deg,azimuth_deg\n30,90\n' >views.csv
printf 'zenith_deg,azimuth_deg\n30\n' >short_views.csv
printf 'zenith_deg,azimuth_deg\n95,0\n' >low_views.csv
printf 'name,value,standard_error\nbrf:30:90,0.6,0\nbrf_albedo,0.51,0.1\n' >expected.csv
printf 'name,value,standard_error\nbrf:31,0.6,0\n' >unknown_name.csv
printf 'name,value,standard_error\nbrf:30,0.6,-1\n' >negative_error.csv
only="trace leaf.obj --period 1 1 --albedo 1 --only-brf --brf-paths 1000"
does '"verdict": "fail"' $only --brf-views views.csv --compare expected.csv --json
does "reference too uncertain" $only --brf-views views.csv --compare expected.csv
does '"brf_bands"' $only --brf 0:60:60 --all-bands --json
does "wrote brf.trace" $only --brf 0:60:60 --checkpoint brf.trace
refuses "brf.trace: made with views" $only --brf 0:60:30 --checkpoint brf.trace
refuses "short_views.csv:2" $only --brf-views short_views.csv
refuses "low_views.csv:2" $only --brf-views low_views.csv
refuses "unknown_name.csv:2" $only --brf 0:60:30 --compare unknown_name.csv
refuses "negative_error.csv:2" $only --brf 0:60:30 --compare negative_error.csv
refuses "--brf 0:60" $only --brf 0:60
refuses "--brf 0:91:1" $only --brf 0:91:1
refuses "--only-brf" $only
refuses "--mes" trace leaf.obj --mes x.mes
refuses "periodic" trace leaf.obj --brf 0:60:30

# What would be ignored is refused, and messages tell which tree is wrong.
for option in "--leaf-species corn" "--albedo 0.5"; do refuses "excludes" trace leaf.obj --spectrum spectrum.csv $option; done
printf '[leaf]\nbands_nm = [650, 550, 450]\n' >bands.toml
refuses "bands.toml:2: leaf.bands_nm: must be with leaves told by species or prospect" trace bands.toml
printf '[tree]\nspecies = "cherry"\ncards = "cut"\n' >cards.toml
refuses "cards.toml:1: [tree] has cards and no file" trace cards.toml
printf '[[tree]]\nfile = "leaf.obj"\n[[tree]]\nfile = "leaf.obj"\nname = "b"\nleaf_species = "oak"\n' >second.toml
refuses "second.toml:3: tree.leaf_species" trace second.toml
conclude
