#!/usr/bin/env bash
# Runs `sunfleck leaf`, and leaves of scenes told by what they are, as a user would: what is wrong must end with status 2
# and one line on stderr, and leave nothing behind. Usage: leaf_command_line.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

printf 'a,b\n1,2\n' >header.csv
printf 'wavelength_nm,reflectance\n500,0.1\n' >few.csv
printf 'wavelength_nm,reflectance\n500,2\n' >high.csv
printf 'wavelength_nm,reflectance\n500,nan\n' >nan.csv
printf 'wavelength_nm,reflectance\n-500,0.1\n' >negative.csv
printf 'wavelength_nm,reflectance\n500\n' >short.csv
printf 'wavelength_nm,transmittance\n5000,0.2\n' >far.csv
: >empty.csv
seq 1 700 | tr '0-9\n' '\000-\011\377' >garbage.csv
mkdir folder.csv

# What is right.
does "0.1512        0.1503" leaf --bands 550
does "beech " leaf --list
does "source: serbinsh" leaf beech
does "Beech, changed" leaf beech --prospect chlorophyll=20
does "carbon_constituents  CBC" leaf --prospect protein=0.001,carbon_constituents=0.008
does '"chlorophyll": 31.57725' leaf beech --json
does "wrote beech.svg" leaf beech --csv beech.csv --bands 400:700:100,850 --bands-csv bands.csv --plot beech.svg
[ "$(wc -l <beech.csv)" -eq 2102 ] || fail "beech.csv has $(wc -l <beech.csv) lines"
[ "$(wc -l <bands.csv)" -eq 5 ] || fail "bands.csv has $(wc -l <bands.csv) lines"
grep -q "let through" beech.svg || fail "beech.svg has no legend"
does "chlorophyll          Cab        31.577 ug/cm^2  +-" leaf --fit beech.csv
does '"state": "held"' leaf --fit beech.csv --hold structure=1.25122 --json
does "850 nm" trace leaf.obj --spectrum bands.csv --paths 1000 --quiet
for command in "trace --paths 1000" "validate --paths 1000 --no-pictures -o report"; do
  # shellcheck disable=SC2086
  does "" $command leaf.obj --leaf-species corn --leaf-prospect chlorophyll=20 --leaf-bands 620:680,550,450 --quiet
done
does "" render leaf.obj --leaf-species corn --size 16 12 --quiet -o x.png
awk -F, 'NR == 1 || ($1 % 10 == 0 && $1 < 700)' beech.csv | cut -d, -f1,2 >visible.csv
does "not seen by these data" leaf --fit visible.csv
{ cat visible.csv; echo "350,0.05"; } >wide.csv
does "1 outside of 400 to 2500 nm left out" leaf --fit wide.csv

does "A                        0.594" leaf --tissue absorption=0.5,scattering=4.5,thickness=0.2
does '"reflectance": 0.26741' leaf --tissue absorption=0.5,scattering=4.5,thickness=0.2 --json
does "transmittance                0.35" leaf --sides reflectance=0.4,transmittance=0.35
# Maps of four places.
printf 'P3 2 2 255  20 40 15  30 60 20  25 50 18  20 40 15' >r.ppm
printf 'P3 2 2 255  25 60 8  20 50 6  30 65 10  25 60 8' >t.ppm
does "wrote oak_upper.png, oak_lower.png, oak.toml" leaf --fit-maps --upper-reflectance r.ppm --lower-reflectance r.ppm \
  --transmittance t.ppm --thickness 0.3 -o oak.png
grep -q "thickness = 0.3 }" oak.toml || fail "oak.toml tells another thickness"
does '"converged": true' leaf --fit-maps --upper-reflectance r.ppm --transmittance t.ppm -o ash.exr --json
printf '[tree]\nfile = "leaf.obj"\n' | cat - oak.toml >oak_tree.toml
does "back to the sky" trace oak_tree.toml --paths 1000 --quiet
does 'wrote a"b_upper.png' leaf --fit-maps --upper-reflectance r.ppm --transmittance t.ppm -o 'a"b.png'
printf '[tree]\nfile = "leaf.obj"\n' | cat - 'a"b.toml' >quoted.toml
does "back to the sky" trace quoted.toml --paths 1000 --quiet
printf '[tree]\nfile = "leaf.obj"\n[leaf]\nslab = { absorption = 0.5, scattering = 4.5, thickness = 0.2 }\n' >slab.toml
does "back to the sky" trace slab.toml --paths 1000 --quiet

# What is wrong.
refuses 'species = "oak": must be one of: almond' leaf oak
refuses '"chlorophyll": must be NAME=VALUE' leaf --prospect chlorophyll
refuses 'chlorophyll = "x": must be a number' leaf --prospect chlorophyll=x
refuses "sugar: must be one of: structure" leaf --prospect sugar=1
refuses "water = 11: must be in [0, 10] cm" leaf --prospect water=11
refuses "water = nan: must be in [0, 10] cm" leaf --prospect water=nan
refuses "structure = 0.99: must be in [1, 10]" leaf --prospect structure=0.99
refuses "dry_matter = 0.01: must be 0 beside" leaf --prospect protein=0.001,dry_matter=0.01
refuses "water: must be there once" leaf --prospect water=0.1,water=0.1
cp beech.csv kept.csv
refuses "must be another file than kept.csv" leaf --fit kept.csv --csv kept.csv
cmp beech.csv kept.csv || fail "what was measured is written over"
refuses "it is no regular file" leaf --fit /dev/zero
refuses "--bands = 300: must be in [400, 2500] nm" leaf --bands 300
refuses "--bands = 500: must be at least the band's lower limit" leaf --bands 600:500
refuses "--bands: width = 0: must be at least 1 nm" leaf --bands 400:500:0
refuses "--bands: width = nan" leaf --bands 400:500:nan
refuses '"400:500:10:3": must be' leaf --bands 400:500:10:3
refuses "must not be empty" leaf --bands ""
refuses ".csv" leaf --csv x.txt
refuses ".svg" leaf --plot x.png
refuses "there is no folder" leaf --plot nowhere/x.svg
refuses "--bands" leaf --bands-csv x.csv
refuses "missing.csv: cannot be read" leaf --fit missing.csv
refuses "folder.csv: cannot be read" leaf --fit folder.csv
refuses "excludes" leaf beech --fit beech.csv
refuses "--fit" leaf --hold water=1
refuses 'header.csv:1: "a,b": must be wavelength_nm' leaf --fit header.csv
refuses "empty.csv:1" leaf --fit empty.csv
refuses "garbage.csv:1" leaf --fit garbage.csv
refuses "few.csv: measured values = 1: must be at least as many" leaf --fit few.csv
refuses "high.csv:2: reflectance = 2: must be in [-0.1, 1.1]" leaf --fit high.csv
refuses "nan.csv:2: reflectance = nan: must be" leaf --fit nan.csv
refuses "negative.csv:2: wavelength_nm = -500: must be" leaf --fit negative.csv
refuses "short.csv:2: 1 fields: must be 2" leaf --fit short.csv
refuses "far.csv: must have at least one row in [400, 2500] nm" leaf --fit far.csv
refuses "--hold: held sugar: must be one of" leaf --fit beech.csv --hold sugar=1
refuses "held protein: must be a content of this kind of leaf" leaf --fit beech.csv --hold protein=0.01
refuses "--json" leaf --list --json
printf 'P3 1 1 255  20 40 15' >one.ppm
printf 'P3 2 2 255  0 0 0  0 0 0  0 0 0  0 0 0' >black.ppm
refuses "requires --transmittance" leaf --fit-maps --upper-reflectance r.ppm -o x.png
refuses "requires --fit-maps" leaf --transmittance t.ppm
refuses "excludes" leaf beech --fit-maps --upper-reflectance r.ppm --transmittance t.ppm -o x.png
refuses "must be .exr or .png" leaf --fit-maps --upper-reflectance r.ppm --transmittance t.ppm -o x.txt
refuses "none.ppm: cannot be read" leaf --fit-maps --upper-reflectance r.ppm --transmittance none.ppm -o x.png
refuses "one.ppm: has 1 x 1 pixels: must have 2 x 2" leaf --fit-maps --upper-reflectance r.ppm --transmittance one.ppm -o x.png
refuses "mean transmittance in red = 0: must be at least 1e-4" leaf --fit-maps --upper-reflectance r.ppm \
  --transmittance black.ppm -o x.png
refuses "in [0.001, 250] mm" leaf --fit-maps --upper-reflectance r.ppm --transmittance t.ppm --thickness 0 -o x.png
mkdir held.toml
refuses "held.toml: cannot be written: it is a folder" leaf --fit-maps --upper-reflectance r.ppm --transmittance t.ppm \
  -o held.png
cp r.ppm kept_upper.png && cp r.ppm kept.toml
refuses "kept_upper.png: must be another file than" leaf --fit-maps --upper-reflectance kept_upper.png --transmittance t.ppm \
  -o kept.png
refuses "kept.toml: must be another file than" leaf --fit-maps --upper-reflectance r.ppm --transmittance kept.toml -o kept.png
refuses "oak_upper.png: must be another file than" render oak_tree.toml -o oak_upper.png
refuses "oak_upper.png: must be another file than" trace oak_tree.toml --picture oak_upper.png
refuses "--tissue: thickness: must be told" leaf --tissue absorption=1,scattering=2
refuses "--tissue: gloss: must be one of: absorption, scattering, thickness" leaf --tissue gloss=1
refuses "--tissue: absorption = -1: must be in [0, 1e6] 1/mm" leaf --tissue absorption=-1,scattering=2,thickness=1
refuses "--sides: reflectance + transmittance = 1.25: must be at most 1" leaf --sides reflectance=0.5,transmittance=0.75
refuses "--sides: transmittance = 0: must be in [1e-4, 1]" leaf --sides reflectance=0.5,transmittance=0
refuses "--sides: thickness = 0: must be above 0" leaf --sides reflectance=0.5,transmittance=0.2,thickness=0
refuses "excludes" leaf beech --sides reflectance=0.5,transmittance=0.2
refuses "excludes" trace leaf.obj --leaf-species corn --albedo 0.5
refuses '--leaf-species = "oak": must be one of' trace leaf.obj --leaf-species oak
refuses "--leaf-prospect: water = 11: must be" render leaf.obj --leaf-prospect water=11 -o y.png
refuses "--leaf-bands: must be with" validate leaf.obj --leaf-bands 450,550,670
refuses "--leaf-bands: number of bands = 2: must be 3" trace leaf.obj --leaf-species corn --leaf-bands 450,550
printf 'wavelength_nm,reflectance,transmittance\n500,0.7,0.5\n' >bright.csv
refuses "bright.csv:2: reflectance + transmittance = 1.2: must be at most 1.1" leaf --fit bright.csv
refuses "--hold: held foo: must be one of" leaf --fit beech.csv --hold foo=1
conclude
