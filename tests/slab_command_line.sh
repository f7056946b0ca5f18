#!/usr/bin/env bash
# Runs `sunfleck slab` and `slab-table` as a user would: what is right must work, and what is wrong must end with status
# 2 and one line on stderr, and leave nothing behind. Usage: slab_command_line.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

mkdir folder
seq 1 700 | tr '0-9\n' '\000-\011\377' >garbage.vdb
printf 'g,omega,thickness,mu0\n0,0.9,1\n' >short.csv
printf 'g,omega,thickness,mu0\n0,0.9,-1,1\n' >negative.csv

refuses "thickness" slab --thickness -1
refuses "omega" slab --omega 2
refuses "omega = 1.0000001: must be in [0, 1]" slab --omega 1.0000001
refuses "g = 1" slab --g 1
refuses "mu0" slab --mu0 0
refuses "needs -o" slab-table
refuses "missing.sft" slab-table missing.sft
refuses "garbage.vdb: is no table of slabs" slab-table garbage.vdb
refuses ".sft" slab-table -o out.bin
refuses "--omega" slab-table --omega 1.1 -o out.sft
refuses "reflectance + transmittance" slab-table --leaves spherical --reflectance 0.9 --transmittance 0.9 -o out.sft
refuses "--leaves" slab-table --omega 0.5 --leaves spherical -o out.sft
refuses "max_error" slab-table --max-error 1e-9 -o out.sft
refuses "there is no folder" slab-table -o nowhere/out.sft
does "error bound" slab-table --omega 0.5 --max-thickness 1 --max-error 0.3 --streams 8 -o out.sft
does '"medium": "Henyey-Greenstein particles, omega 0.5, g 0"' slab-table out.sft --json
head -c 1000 out.sft >cut.sft
refuses "cut.sft: is cut short" slab-table cut.sft
refuses "short.csv:2" slab --batch short.csv
refuses "negative.csv:2" slab --batch negative.csv
refuses "number" slab --omega ""
refuses "--json" --json slab
"$program" slab >/dev/full 2>/dev/null && fail "slab: lost output is no success"
# The slab's options: values out of range, files that are wrong, and options that do not go together.
for streams in 0 1 7 258 x 4.5; do refuses "--streams" slab --streams $streams; done
for tolerance in 0 -1 2 nan x; do refuses "--tolerance" slab --tolerance $tolerance; done
for value in nan 1 -1 x; do refuses "g" slab --g $value; done
for value in 0 -0.5 1.5 nan inf; do refuses "mu0" slab --mu0 $value; done
for value in 0 nan -inf; do refuses "thickness" slab --thickness $value; done
for value in 11 -1 nan; do refuses "depth" slab --depths 0,$value; done
refuses "depth" slab --thickness inf --depths inf
for value in 0 1.1 -2 nan; do refuses "mu = " slab --mu 1,$value; done
for value in 361 nan inf x; do refuses "phi" slab --phi 0,$value; done
for value in -0.1 1.1 nan; do refuses "ground-albedo" slab --ground-albedo $value; done
for value in 0 -1 nan inf; do refuses "sky" slab --sky $value; done
refuses "model = foo" slab --model foo
refuses "twice" slab --model pp,pp
for option in --residual --no-delta-m --no-corrections "--streams 8" "--tolerance 1e-3"; do
  refuses "${option%% *}: is for the model pp" slab --model spp $option
done
refuses "must be pp" slab --model spp --sky 1
refuses "must be pp" slab --model pp,spp --ground-albedo 0.5
refuses "must be pp for layers, a hot spot" slab --model best --leaves spherical --hot-spot 0.1
refuses "model = mc: must be pp" slab --model mc --leaves spherical
for name in nstream:0 nstream:9 nstream: ; do refuses "model = $name: must be" slab --model $name; done
for name in nstream:2:5 nstream:2:0 nstream:2: nstream:8:17; do
  refuses "ORDERS from 1 to 2 N or all" slab --model $name
done
for leaves in none spherical:2 ellipsoidal ellipsoidal:0 ellipsoidal:x beta:57 beta:90,20 beta:57,0 beta:57,20,3 ""; do
  refuses "lea" slab --leaves "$leaves"
done
refuses "reflectance + transmittance" slab --leaves spherical --reflectance 0.6 --transmittance 0.5
for value in -0.1 1.1 nan; do
  refuses "reflectance" slab --leaves spherical --reflectance $value
  refuses "transmittance" slab --leaves spherical --transmittance $value
  refuses "hot-spot" slab --leaves spherical --hot-spot ${value/1.1/11}
done
for option in --reflectance --transmittance --hot-spot; do refuses "requires --leaves" slab $option 0.1; done
printf '0.5\n0.2\n' >no_unit.txt
printf '1\n0.5, x\n' >word.txt
printf '1,0.5\n1.5\n' >too_large.txt
printf 'thickness,omega,g\n1,0.9,0.5\n2,1.5,0\n' >layer_albedo.csv
printf 'thickness,omega,g\ninf,0.9,0.5\n2,0.5,0\n' >inner_infinity.csv
printf 'thickness,omega,g\n1,0.9\n' >layer_fields.csv
printf 'thickness,omega\n1,0.9\n' >layer_header.csv
printf 'thickness,omega,g\n' >no_layer.csv
: >empty
for option in --moments --layers --batch; do
  refuses "nofile" slab $option nofile
  refuses "folder" slab $option folder
  refuses "empty" slab $option empty
  refuses "$option" slab $option ""
done
refuses "no_unit.txt" slab --moments no_unit.txt
refuses "word.txt:2" slab --moments word.txt
refuses "too_large.txt:2: chi_2" slab --moments too_large.txt
refuses "layer_albedo.csv:3: omega" slab --layers layer_albedo.csv
refuses "inner_infinity.csv:3" slab --layers inner_infinity.csv
refuses "layer_fields.csv:2" slab --layers layer_fields.csv
refuses "layer_header.csv:1" slab --layers layer_header.csv
refuses "no_layer.csv" slab --layers no_layer.csv
refuses "excludes" slab --tolerance 1e-3 --streams 8
for value in 0 0% -1% 101% 1.5 nan inf x % "" "1 %%"; do refuses "--max-error" slab --max-error "$value"; done
for option in "--model spp" "--streams 8" "--tolerance 1e-3" --residual --no-delta-m "--paths 1000"; do
  refuses "excludes" slab --max-error 1% $option
done
refuses "thickness" slab --max-error 1% --thickness -1
printf 'g,omega,thickness,mu0\n0,0.9,1,0\n' >short_zero.csv
refuses "short_zero.csv:2: mu0" slab --max-error 1% --batch short_zero.csv
refuses "excludes" slab --leaves spherical --omega 0.5
refuses "excludes" slab --layers no_layer.csv --thickness 2
refuses "excludes" slab --moments word.txt --g 0.5
refuses "requires --plot" slab --plot-log
refuses "requires --batch" slab -o x.csv
refuses ".svg" slab --plot x.png
refuses "nowhere" slab --plot nowhere/x.svg
refuses "mu0 = 1e-50: must be at least 1e-07" slab --model twostream --mu0 1e-50
printf 'g,omega,thickness,mu0\n0,0.9,1,1e-50\n' >grazing.csv
refuses "mu0 = 1e-50: must be at least 1e-07" slab --model sppr --batch grazing.csv
# Files of slabs: what is wrong is named by line and field wherever it stands, and leaves nothing behind.
awk 'BEGIN { print "g,omega,thickness,mu0"
             for (i = 0; i < 18000; ++i) printf "%.3f,%.4f,%s,%.3f\n", i % 1900 / 1000 - 0.95, i / 17999,
               i % 7 ? i % 97 / 10 + 0.01 : "inf", i % 999 / 1000 + 0.001 }' >many.csv
sed '17000s/,/,x/' many.csv >word.csv
sed '17000s/$/,1/; 17500s/,/,x/' many.csv >long_row.csv
sed '17000s/,[^,]*$//' many.csv >short_row.csv
sed '17000s/[^,]*$/0/' many.csv >zero.csv
sed '17000s/^[^,]*/nan/' many.csv >nan.csv
printf 'g,omega,thickness\n0,0.9,1\n' >missing_column.csv
head -c 600000 /dev/zero | tr '\0' 1 >one_line.csv
for to in "" "-o results.csv"; do
  refuses "word.csv:17000: omega" slab --batch word.csv $to
  refuses "long_row.csv:17000" slab --batch long_row.csv $to
  refuses "short_row.csv:17000" slab --batch short_row.csv $to
  refuses "zero.csv:17000: mu0" slab --batch zero.csv $to
  refuses "nan.csv:17000: g" slab --batch nan.csv $to
  refuses "missing_column.csv:1" slab --batch missing_column.csv $to
  refuses "one_line.csv:1" slab --batch one_line.csv $to
done
refuses "nowhere" slab --batch many.csv -o nowhere/x.csv
refuses "folder" slab --batch many.csv -o folder
refuses "--json" slab --batch many.csv --json
refuses "one model" slab --batch many.csv --model pp,spp
refuses "other than mc" slab --batch many.csv --model mc
refuses "excludes" slab --batch many.csv --omega 0.5
does "reflectance" slab --omega 1 --thickness 5

printf 'g,omega,thickness,mu0\n0,1,inf,1\n0.5,0.9,10,0.5\n' >cases.csv
does "g,omega,thickness,mu0,reflectance,transmittance,direct" slab --batch cases.csv
does "0,1,inf,1,1," slab --model spp --batch cases.csv
"$program" slab --batch many.csv --streams 4 -o results.csv || fail "slab --batch: status $?"
cut -d, -f1-4 results.csv | cmp -s - many.csv || fail "slab --batch: lines are lost or out of order"
# With four streams the series of a backward peak may be negative somewhere: 1e-6 of the light in a thin slab.
awk -F, 'NR > 1 && !(NF == 7 && $5 + 0 >= 0 && $6 + 1e-5 >= $7 + 0 && $5 + $6 < 1.0000001) { exit 1 }' results.csv ||
  fail "slab --batch: a line holds no fluxes"
"$program" slab --batch many.csv --streams 4 --threads 1 | cmp -s - results.csv ||
  fail "slab --batch: the results depend on the number of threads or on where they go"
"$program" slab --batch - <many.csv >/dev/null 2>&1; [ $? -eq 2 ] || fail "slab --batch -: no such file"
printf 'g,omega,thickness,mu0\r\n +0.5 , 5e-1,INF,1\r\n\n0,0,1,.5' >loose.csv
does "+0.5 , 5e-1,INF,1," slab --batch loose.csv
does "0,0,1,.5,0,0.1353352832366" slab --model spp --batch loose.csv
"$program" slab --batch many.csv --streams 4 >/dev/full 2>/dev/null && fail "slab --batch: lost output is no success"

printf '1\n0.5\n0.2, 0.05\n' >moments.txt
printf 'thickness,omega,g\n1,0.9,0.5\ninf,0.5,0\n' >layers.csv
does "mean intensity" slab --depths 0,5
does "phi 90 deg" slab --mu 1,-0.5 --phi 0,90
does '"phi_deg": 90.0' slab --mu 1,-0.5 --phi 0,90 --json
does '"radiance": []' slab --json
does "residual" slab --residual
does "is within" slab --tolerance 1e-2
does "reflectance" slab --moments moments.txt --no-delta-m --no-corrections
for model in spp sppr twostream nstream best nstream:3:all nstream:1; do
  does "mean intensity" slab --model $model --moments moments.txt --depths 1
  does "mean intensity" slab --model $model --leaves planophile --thickness 3 --depths 1
done
does "reflectance" slab --layers layers.csv --ground-albedo 0.5
does "reflectance" slab --leaves ellipsoidal:1.5 --reflectance 0.4 --transmittance 0.4 --hot-spot 0.1 --thickness 3
does "reflectance" slab --leaves beta:57,20 --thickness 3
does "unit of the sky's" slab --sky 1 --depths 1
does "wrote field.svg" slab --model pp,spp --g 0.5 --depths 0,1 --plot field.svg --plot-log
tail -c 7 field.svg | grep -q "</svg>" || fail "slab --plot: no whole picture"
does '"models"' slab --model pp,spp --json
does "Within 1 %: nstream:2:1, at most" slab --max-error 1%
does "Within 1 %: nstream:2:1, at most" slab --max-error 0.01
does '"promised_error"' slab --max-error 30% --json
does "RMS over all directions" slab --max-error 5% --mu 1,-0.5 --g 0.3
does "the exact solver, since no closed form keeps it" slab --max-error 1e-6
does "the exact solver, since the slab is outside of the map" slab --max-error 1% --mu0 0.01
does "the exact solver, since errors of closed forms are not mapped" slab --max-error 1% --ground-albedo 0.5
does '"reason"' slab --max-error 1% --ground-albedo 0.5 --json
for leaves in spherical planophile erectophile plagiophile extremophile uniform; do
  does "shares, fluxes and leaf irradiance" slab --max-error 5% --leaves $leaves --thickness 3 --depths 0,1
done
does "<- the cheapest that keeps it" slab --max-error 3% --leaves planophile --reflectance 0.6 --transmittance 0.35
does '"leaf_irradiance"' slab --max-error 3% --leaves uniform --thickness 2 --depths 1 --json
for leaves in ellipsoidal:1.5 beta:57,20; do
  does "are not mapped for leaves inclined otherwise than spherical" slab --max-error 3% --leaves $leaves --thickness 3
done
does "are not mapped for layers, a ground, a sky or a hot spot" slab --max-error 3% --leaves spherical --hot-spot 0.1
does "are not mapped for radiance in leaves" slab --max-error 3% --leaves spherical --mu 0.5
does "are not mapped for moments" slab --max-error 3% --moments moments.txt
does "N = 16 is within" slab --max-error 1% --mu0 0.01
does "leaf irradiance" slab --leaves erectophile --thickness 3 --depths 1
does "wrote chosen.svg" slab --max-error 2% --plot chosen.svg
grep -q "N =" chosen.svg && fail "slab --max-error --plot: a closed form has no N of the exact solver"
grep -q "N = " field.svg || fail "slab --plot: the N of the exact solver is not told"
does "nstream:1 (1 stream, 2 azimuth orders, refined)" slab --model nstream:1
"$program" slab --max-error 1% --depths 1 | grep -q "radiance \[" && fail "slab --max-error: radiance nobody asked for"
does "g,omega,thickness,mu0,reflectance,transmittance,direct,model" slab --max-error 1% --batch cases.csv --quiet
"$program" slab --max-error 1% --batch many.csv -o chosen.csv 2>turns.txt || fail "slab --max-error --batch: status $?"
cut -d, -f1-4 chosen.csv | cmp -s - many.csv || fail "slab --max-error --batch: lines are lost or out of order"
"$program" slab --max-error 1% --batch many.csv --quiet --threads 1 | cmp -s - chosen.csv ||
  fail "slab --max-error --batch: the results depend on the number of threads"
[ "$(awk '{ rows += $2 } END { print rows }' turns.txt)" -eq 18000 ] || fail "slab --max-error --batch: rows not counted"
grep -q "spp:" turns.txt && grep -q "pp:16:" turns.txt || fail "slab --max-error --batch: $(cat turns.txt)"
head -n 3001 many.csv >few.csv
# 1 %, and a little for what N = 64 is off itself in the flattest light.
"$program" slab --batch few.csv --streams 64 -o exact.csv && head -n 3001 chosen.csv | paste -d, exact.csv - |
  awk -F, 'NR > 1 { for (i = 5; i < 7; ++i) if (($i - $(i + 7)) ^ 2 > 0.011 ^ 2) exit 1 }' ||
  fail "slab --max-error --batch: an error is not kept"

# A batch that is interrupted writes all (0) or nothing.
for delay in 0.02 0.05 0.1; do
  timeout --preserve-status -s INT $delay "$program" slab --model spp --batch many.csv -o cut.csv >/dev/null 2>stderr.txt
  status=$?
  case $status in
    0) cut -d, -f1-4 cut.csv | cmp -s - many.csv || fail "slab --batch, interrupted after $delay s: not whole" ;;
    1 | 130) [ -z "$(ls -A | grep 'cut.*csv')" ] || fail "slab --batch, interrupted after $delay s: left something behind" ;;
    *) fail "slab --batch, interrupted after $delay s: status $status: $(head -c 400 stderr.txt)" ;;
  esac
  rm -f cut.csv
done

conclude
