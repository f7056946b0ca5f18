#!/usr/bin/env bash
# Check that a trace that is killed a hundred times, at random moments, ends with the bits of one that never was: its
# file byte for byte, and what it prints. Usage: killed_trace.sh PATH_TO_SUNFLECK [KILLS]
source "$(dirname "$0")/as_a_user.bash" "$1"
wanted=${2:-100}
# Three thousand leaves and bands of three colours make a file of a megabyte, written after every unit: most of the time
# goes into writing.
awk 'BEGIN { srand(1); print "usemtl leaf"
             for (i = 0; i < 3000; ++i) { x = 2 * rand(); y = 2 * rand(); z = rand()
               for (corner = 0; corner < 3; ++corner) print "v", x + 0.1 * rand(), y + 0.1 * rand(), z + 0.1 * rand()
               print "f -1 -2 -3" } }' >leaves.obj
run="trace leaves.obj --period 2 2 --paths 1e6 --all-bands --albedo 0.5 --json"
shares() { grep -v seconds "$1"; }
"$program" $run --checkpoint whole.trace >whole.json || exit 1

# How long a run takes to write its file for the first time.
begin=$(date +%s%N)
"$program" $run --checkpoint killed.trace --write-every 0 >/dev/null 2>&1 &
while [ ! -e killed.trace ]; do sleep 0.005; done
first=$((($(date +%s%N) - begin) / 1000000))
kill -KILL $!
wait $! 2>/dev/null

kills=0 begun=0 writing=0 ends=0
# A run that came to its end before it was killed is compared and begun again.
end() {
  cmp whole.trace killed.trace || exit 1
  [ "$(shares killed.json)" = "$(shares whole.json)" ] || { diff killed.json whole.json; exit 1; }
  ends=$((ends + 1))
}
RANDOM=20261123
while [ $kills -lt "$wanted" ] && [ $ends -lt "$wanted" ]; do
  delay=$((first * (50 + RANDOM % 80) / 100))
  timeout -s KILL $(printf %d.%03d $((delay / 1000)) $((delay % 1000))) "$program" $run --checkpoint killed.trace --write-every 0 >killed.json 2>errors.txt
  status=$?
  if [ $status -eq 137 ]; then
    kills=$((kills + 1))
    [ -e killed.trace ] && begun=$((begun + 1))
    for left in .killed.*.trace; do [ -e "$left" ] && writing=$((writing + 1)) && rm "$left"; done
  elif [ $status -eq 0 ]; then
    end
    rm killed.trace
  else
    echo "status $status: $(cat errors.txt)"; exit 1
  fi
done 2>/dev/null  # the shell tells of each kill
"$program" $run --checkpoint killed.trace >killed.json || exit 1
end
echo "$kills kills, $begun with a file to go on from, $writing while one was being written, $ends ends"
[ $kills -eq "$wanted" ] && [ $begun -ge $((wanted / 3)) ] && [ $writing -ge $((wanted / 10)) ]
