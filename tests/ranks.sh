#!/usr/bin/env bash
# Runs the program as several ranks: they must find, to the last bit, what one process finds, also when they are killed
# or stopped and go on. Usage: ranks.sh PATH_TO_SUNFLECK PATH_TO_MPIRUN
source "$(dirname "$0")/as_a_user.bash" "$1"
mpirun=$2

# As root, on fewer cores than ranks and where one process may not read another's memory, as in a container.
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
export OMPI_MCA_btl_vader_single_copy_mechanism=none
ranks() { local count=$1; shift; "$mpirun" -n "$count" "$program" "$@" </dev/null; }
shares() { grep -v seconds "$1"; }

printf 'v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nusemtl leaf\nf 1 2 3 4\n' | tee leaf.obj >two.obj
printf 'v 0 0 2\nv 1 0 2\nv 1 1 2\nf 5 6 7\n' >>two.obj
run="trace leaf.obj --period 2 2 --paths 1e5 --samples 4 --size 20 20 --json --threads 1"
all="$run --brf 0:60:60 --brf-paths 2000"
"$program" $all --checkpoint alone.trace >alone.json || fail "$all"
for count in 2 3; do
  ranks $count $all --checkpoint ranks.trace --picture ranks.exr --leaves ranks.csv >ranks.json 2>stderr.txt ||
    fail "$count ranks: $(cat stderr.txt)"
  [ "$(shares ranks.json)" = "$(shares alone.json)" ] || fail "$count ranks: $(diff ranks.json alone.json)"
  cmp -s ranks.trace alone.trace || fail "$count ranks: the checkpoint differs"
  [ -s ranks.exr ] && [ -s ranks.csv ] || fail "$count ranks: a file is missing"
  rm -f ranks.*
done
"$program" $run --target 4% >alone_target.json || fail "--target"
ranks 2 $run --target 4% >target.json 2>stderr.txt || fail "--target over ranks: $(cat stderr.txt)"
[ "$(shares target.json)" = "$(shares alone_target.json)" ] || fail "--target: $(diff target.json alone_target.json)"

# Without a period over black ground a picture comes by paths of light.
for target in "" "--target 4%"; do
  light="trace two.obj --only-picture --sun-zenith 30 --elevation 60 --samples 16 --size 20 20 --json --threads 1 $target"
  "$program" $light --checkpoint alone_light.trace >alone_light.json || fail "$light"
  ranks 2 $light --checkpoint light.trace >light.json 2>stderr.txt || fail "$light over ranks: $(cat stderr.txt)"
  [ "$(shares light.json)" = "$(shares alone_light.json)" ] || fail "$light: $(diff light.json alone_light.json)"
  cmp -s light.trace alone_light.trace || fail "$light: the checkpoint differs"
  rm -f ./*light.trace
done

# Killed and stopped in the middle it goes on, also as another number of ranks.
long="trace leaf.obj --period 2 2 --paths 4e6 --json --threads 1"
"$program" $long --checkpoint long.trace >long.json || fail "$long"
cut=0
# cuts_after FILE SIGNAL ARGUMENTS...: two ranks whose mpirun gets the signal once the file is there and has changed
cuts_after() {
  local file=$1 signal=$2 before; shift 2
  before=$(md5sum "$file" 2>/dev/null)
  "$mpirun" -n 2 "$program" "$@" >/dev/null 2>&1 </dev/null &
  for _ in $(seq 1000); do [ -s "$file" ] && [ "$(md5sum "$file")" != "$before" ] && break; sleep 0.02; done
  kill -$signal $!
  wait $! && cut=$((cut - 1))  # it was done before
  cut=$((cut + 1))
  for _ in $(seq 100); do [ -e "$file.lock" ] || break; sleep 0.1; done  # ranks outlive an mpirun that is killed
}
set -m  # or what runs behind does not hear of Ctrl-C
for signal in KILL INT; do cuts_after cut.trace $signal $long --checkpoint cut.trace --write-every 0; done 2>/dev/null
[ $cut -gt 0 ] || fail "no run was cut in the middle"
ranks 3 $long --checkpoint cut.trace >cut.json 2>stderr.txt || fail "going on: $(cat stderr.txt)"
[ "$(shares cut.json)" = "$(shares long.json)" ] || fail "going on: $(diff cut.json long.json)"
cmp -s cut.trace long.trace || fail "going on: the checkpoint differs"

# A sweep over ranks gives the same table, also when it is killed and goes on as one process.
cat >sweep.toml <<'TEXT'
scenes = ["leaf.obj", "two.obj"]
models = ["mc", "ss"]
[sun]
zenith_deg = [0, 10, 20, 30, 40, 50]
[leaf]
albedo = [0.2, 0.9]
[effort]
paths = 1e5
TEXT
"$program" sweep sweep.toml -o alone.csv --threads 1 >/dev/null || fail "sweep"
ranks 3 sweep sweep.toml -o ranks.csv --threads 1 >stdout.txt 2>stderr.txt || fail "sweep over ranks: $(cat stderr.txt)"
grep -q "wrote ranks.csv: 48 of 48 rows, by 12 traces now" stdout.txt || fail "sweep over ranks: $(cat stdout.txt)"
cmp -s alone.csv ranks.csv || fail "sweep over ranks: another table"
cuts_after cut.csv.rows KILL sweep sweep.toml -o cut.csv --threads 1 2>/dev/null
"$program" sweep sweep.toml -o cut.csv >/dev/null || fail "a sweep that was cut"
cmp -s alone.csv cut.csv || fail "a sweep that was cut: another table"

# A mistake is told once; a rank that dies ends all.
ranks 2 trace nowhere >stdout.txt 2>stderr.txt
[ $? -eq 2 ] || fail "a wrong scene: not status 2"
[ "$(grep -c "^sunfleck: " stderr.txt)" -eq 1 ] || fail "a wrong scene: $(cat stderr.txt)"
[ ! -s stdout.txt ] || fail "a wrong scene: $(cat stdout.txt)"
ranks 2 merge long.trace -o merged.trace >stdout.txt 2>stderr.txt && fail "merge by several ranks"
grep -q "started without mpirun" stderr.txt || fail "merge by several ranks: $(cat stderr.txt)"
ln -s leaf.obj rank0.obj
printf 'v 0 0 1\nv 1 0 1\nv 1 1 1\nusemtl leaf\nf 1 2 3\n' >rank1.obj
cat >differently <<'TEXT'
#!/bin/sh
exec "$1" trace "rank$OMPI_COMM_WORLD_RANK.obj" --period 2 2 --paths 1000
TEXT
chmod +x differently
"$mpirun" -n 2 ./differently "$program" </dev/null >stdout.txt 2>stderr.txt && fail "ranks with different scenes"
grep -q "^sunfleck: rank 1: this rank: made with hash of trees" stderr.txt || fail "different scenes: $(cat stderr.txt)"
cat >dying <<'TEXT'
#!/bin/sh
[ "$OMPI_COMM_WORLD_RANK" = 0 ] || (sleep 1; kill -KILL $$) &
exec "$1" trace leaf.obj --period 2 2 --paths 1e12 --threads 1
TEXT
chmod +x dying
timeout 60 "$mpirun" -n 2 ./dying "$program" </dev/null >stdout.txt 2>stderr.txt
case $? in 0 | 124) fail "a rank died and the others went on" ;; esac
grep -q "signal 9" stderr.txt || fail "a rank died: $(cat stderr.txt)"

conclude
