#!/usr/bin/env bash
# Sweeps as a user would: the table has every combination and is the same to the last byte however the sweep was killed,
# cut into parts, or changed and changed back; wrong files are refused. Usage: sweep.sh PATH_TO_SUNFLECK
source "$(dirname "$0")/as_a_user.bash" "$1"

mkdir scenes
printf 'v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl leaf\nf 1 2 3 4\n' >scenes/leaf.obj
printf '[tree]\nfile = "leaf.obj"\n[stand]\nkind = "periodic"\nperiod = [1.0, 1.0]\n[leaf]\nreflectance = [0.1, 0.5, 0.3]\n
transmittance = [0.2, 0.5, 0.1]\n' >scenes/floor.toml

# A horizontal leaf that fills its period meets all light once: its shares are its optics, in every combination. Of
# albedos there are seventeen, more than one path carries.
cat >floor.toml <<'TEXT'
scenes = "scenes/floor.toml"
models = ["mc", "ss"]
[sun]
zenith_deg = [0, 60]
[leaf]
albedo = [0.05, 0.10, 0.15, 0.20, 0.25, 0.30, 0.35, 0.40, 0.45, 0.50, 0.55, 0.60, 0.65, 0.70, 0.75, 0.80, 0.85]
[effort]
paths = 1000
TEXT
does "68 rows, 68 of them to be computed by 4 traces" sweep floor.toml -o floor.csv --dry-run
[ -z "$(ls | grep '^floor.csv')" ] || fail "--dry-run left something behind"
does "wrote floor.csv: 68 of 68 rows" sweep floor.toml -o floor.csv
# Light of a path is held in single precision: 1e-6 of it. Whether it is reflected or passes is left to chance: 5
# standard errors, the same throws for all suns and optics.
awk -F, 'function far(a, b, by) { return (a - b) ^ 2 > by ^ 2 }
  NR > 1 && $13 == "mc" && (far($15, $5, 5 * $16) || far($15 + $21, $5 + $6, 1e-6) || far($17, 1 - $5 - $6, 1e-6)) { exit 1 }
  NR > 1 { ++rows[$13] }
  END { if (rows["mc"] != 34 || rows["ss"] != 34) exit 1 }' floor.csv || fail "the leaf's shares: $(cat floor.csv)"
[ "$(awk -F, 'NF != 31' floor.csv | wc -l)" -eq 0 ] || fail "rows of other lengths"
printf 'scenes = "scenes/floor.toml"\n[leaf]\nband = [0, 1, 2]\n[effort]\npaths = 1000\n' >bands.toml
does "3 of 3 rows" sweep bands.toml -o bands.csv
[ "$(cut -d, -f4,5,6 bands.csv | tr '\n' ' ')" = "band,leaf_reflectance,leaf_transmittance 0,0.1,0.2 1,0.5,0.5 2,0.3,0.1 " ] ||
  fail "bands: $(cat bands.csv)"
printf 'scenes = "scenes/floor.toml"\n[leaf]\nreflectance = [0.1, 0.2]\ntransmittance = [0.3, 0.4]\n[ground]\nalbedo = [0, 0.5]\n[wood]\nreflectance = [0, 1]\n[effort]\ntarget = 0.05\nseed = 7\n' >pairs.toml
does "8 of 8 rows" sweep pairs.toml -o pairs.csv
[ "$(cut -d, -f5,6,7,8,10,12 pairs.csv | sed -n '2p;9p' | tr '\n' ' ')" = "0.1,0.3,0,0,7,0.05 0.2,0.4,1,0.5,7,0.05 " ] ||
  fail "pairs: $(cat pairs.csv)"
# One row is what trace and validate tell of it.
printf 'scenes = "scenes/leaf.obj"\nmodels = ["mc", "spp"]\n[wood]\ntraced = false\n[sun]\nzenith_deg = 20\n[leaf]\nalbedo = 0.9\n[effort]\npaths = 3000\nseed = 3\n' >one.toml
does "2 of 2 rows" sweep one.toml -o one.csv
alike="scenes/leaf.obj --sun-zenith 20 --albedo 0.9 --paths 3000 --seed 3 --json"
"$program" trace $alike --without-wood >trace.json || fail "trace"
for column in 15:reflected 17:absorbed_leaves 21:arriving_ground; do
  grep -q "^  \"${column#*:}\": $(cut -d, -f${column%:*} one.csv | sed -n 2p)" trace.json || fail "$column: $(cat trace.json one.csv)"
done
"$program" validate $alike --stand single --no-pictures -o report >validate.json || fail "validate"
grep -q "\"rms_leaf\": $(cut -d, -f30 one.csv | sed -n 3p | cut -c 1-6)" validate.json || fail "rms_leaf: $(cat one.csv validate.json)"

# Killed again and again it ends with the same table; so it does in parts, with a damaged line, and after a change.
sed 's/paths = 1000/paths = 1e5/; s/zenith_deg = .*/zenith_deg = [0, 10, 20, 30, 40, 50, 60, 70]/' floor.toml >long.toml
"$program" sweep long.toml -o whole.csv --threads 1 >/dev/null || fail "long.toml"
kills=0
for tasks in 1 4 7; do  # once so many of the 16 tasks of 34 or 2 rows are finished
  "$program" sweep long.toml -o killed.csv --threads 1 >/dev/null 2>&1 </dev/null &
  for _ in $(seq 1000); do [ -s killed.csv.rows ] && [ "$(wc -l <killed.csv.rows)" -gt $((17 * (tasks - 1))) ] && break; sleep 0.02; done
  kill -KILL $!
  wait $!
  [ $? -eq 137 ] && [ "$(wc -l <killed.csv.rows)" -lt 272 ] && kills=$((kills + 1))
done 2>/dev/null
[ $kills -gt 0 ] || fail "no sweep was killed in the middle"
printf 'half a li' >>killed.csv.rows
does "272 of 272 rows" sweep long.toml -o killed.csv
cmp whole.csv killed.csv || fail "killed"
[ "$(sort killed.csv.rows | uniq -d | wc -l)" -eq 0 ] || fail "killed: finished rows were computed again"
set -m  # or what runs behind does not hear of Ctrl-C
"$program" sweep long.toml -o ended.csv --threads 1 >stdout.txt 2>stderr.txt </dev/null &
for _ in $(seq 1000); do [ -s ended.csv.rows ] && break; sleep 0.02; done
kill -INT $!
wait $!
[ $? -eq 1 ] && grep -q "the same command goes on" stderr.txt || fail "interrupted: $(cat stderr.txt)"
[ "$(wc -l <ended.csv)" -eq $((1 + $(wc -l <ended.csv.rows))) ] || fail "interrupted: the table is not what is finished"
set +m
for part in 3 1 2; do does "part $part of 3" sweep long.toml -o parts.csv --part $part/3; done
[ ! -e parts.csv ] || fail "a part wrote the table"
does "272 of 272 rows, by 0 traces now" sweep long.toml -o parts.csv
cmp whole.csv parts.csv || fail "parts"
sed -i '5s/0\./9./' parts.csv.2of3.rows
"$program" sweep long.toml -o parts.csv >stdout.txt 2>stderr.txt || fail "a damaged line: $(cat stderr.txt)"
grep -q "parts.csv.2of3.rows:5: damaged" stderr.txt || fail "a damaged line: $(cat stderr.txt)"
grep -q "by 1 traces now" stdout.txt || fail "a damaged line: $(cat stdout.txt)"
cmp whole.csv parts.csv || fail "a damaged line"
sed -i 5d parts.csv.2of3.rows  # or each run tells of it
sed 's/50, 60/55, 60/' long.toml >changed.toml
does "by 2 traces now" sweep changed.toml -o parts.csv
does "by 0 traces now" sweep long.toml -o parts.csv
cmp whole.csv parts.csv || fail "changed back"

# What is wrong.
wrong() { local expected=$1; shift; printf "$@" >wrong.toml; refuses "$expected" sweep wrong.toml -o x.csv; }
wrong "wrong.toml: scenes: must be there" ''
wrong "wrong.toml:1:" 'scenes = \n'
wrong "wrong.toml:2: unknown key \"scene\"" 'scenes = "slab"\nscene = "slab"\n'
wrong "wrong.toml:3: unknown key \"zenith\" in [sun]; see: sunfleck --help sweep" 'scenes = "slab"\n[sun]\nzenith = 3\n'
wrong "wrong.toml:3: sun.zenith_deg = 95" 'scenes = "slab"\n[sun]\nzenith_deg = [0, 95]\n'
wrong "wrong.toml:3: sun.zenith_deg = 4" 'scenes = "slab"\n[sun]\nzenith_deg = [4, 4]\n'
wrong "wrong.toml:3: sun.zenith_deg = []" 'scenes = "slab"\n[sun]\nzenith_deg = []\n'
wrong "wrong.toml:3: sun.zenith_deg = nan" 'scenes = "slab"\n[sun]\nzenith_deg = nan\n'
wrong "wrong.toml:1: scenes = []" 'scenes = []\n'
wrong "there once" 'scenes = ["slab", "slab"]\n'
wrong "must be of mc, ss, spp, sppg" 'scenes = "slab"\nmodels = "exact"\n'
wrong "one alone of albedo" 'scenes = "slab"\n[leaf]\nalbedo = 1\nband = 1\n'
wrong "both reflectance and transmittance" 'scenes = "slab"\n[leaf]\nreflectance = 1\n'
wrong "taken in pairs" 'scenes = "slab"\n[leaf]\nreflectance = [0.1, 0.2]\ntransmittance = 0.1\n'
wrong "there once" 'scenes = "slab"\n[leaf]\nreflectance = [0.1, 0.1]\ntransmittance = [0.2, 0.2]\n'
wrong "must be at most 1" 'scenes = "slab"\n[leaf]\nreflectance = 0.7\ntransmittance = 0.7\n'
wrong "leaf.band = 0.5" 'scenes = "slab"\n[leaf]\nband = [0.5]\n'
wrong "wood.traced = 1" 'scenes = "slab"\n[wood]\ntraced = 1\n'
wrong "effort.paths = 3" 'scenes = "slab"\n[effort]\npaths = 3\n'
wrong "dots on end" "a$(printf '.a%.0s' $(seq 100)) = 1\n"
wrong "nowhere" 'scenes = "nowhere"\n'
wrong "missing.obj" 'scenes = "missing.obj"\n'
wrong "0 for validation" 'scenes = "slab"\nmodels = "ss"\n[ground]\nalbedo = 0.1\n'
wrong "scenes/leaf.obj: ground" 'scenes = "scenes/leaf.obj"\n[ground]\nalbedo = 0.1\n'
degrees=$(seq -s, 0 0.05 89.9)
wrong "rows: must be at most 1000000" "scenes = \"slab\"\n[sun]\nzenith_deg = [$degrees]\nazimuth_deg = [$degrees]\n"
refuses "none.toml" sweep none.toml -o x.csv
refuses "extension .csv" sweep floor.toml -o x.txt
refuses "K/N" sweep floor.toml -o x.csv --part 4/3
refuses "nowhere/x.csv" sweep floor.toml -o nowhere/x.csv
refuses "--output" sweep floor.toml
does "zenith_deg" --help sweep

conclude
