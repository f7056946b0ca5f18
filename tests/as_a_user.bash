# For the tests that run the program as a user would: sourced with its path, it goes to an empty folder that is gone
# afterwards. `fail` tells and counts what is wrong; the test ends with `conclude`.
set -u
program=$(readlink -f "$1")
place=$(mktemp -d)
trap 'rm -rf "$place" "$place.before"' EXIT
cd "$place" || exit 1
# A level leaf of 1 x 1 m.
square='v 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n'
printf "$square"'usemtl leaf\nf 1 2 3 4\n' >leaf.obj
failures=0
fail() { echo "FAILED: $*"; failures=$((failures + 1)); }
conclude() {
  [ $failures -eq 0 ] && echo "all as it should be"
  exit $((failures > 0))
}

# refuses WHAT_THE_MESSAGE_MUST_HOLD ARGUMENTS...
refuses() {
  local expected=$1; shift
  find . | sort >"$place.before"
  "$program" "$@" >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq 2 ] || fail "$* : status $status, not 2: $(head -c 400 stderr.txt)"
  [ "$(wc -l <stderr.txt)" -eq 1 ] || fail "$* : not one line on stderr: $(head -c 600 stderr.txt)"
  grep -qiF -- "$expected" stderr.txt || fail "$* : \"$expected\" is not in: $(cat stderr.txt)"
  [ ! -s stdout.txt ] || fail "$* : wrote to stdout: $(head -c 200 stdout.txt)"
  rm -f stdout.txt stderr.txt
  diff <(find . | sort) "$place.before" >/dev/null || fail "$* : left something behind: $(find . | tr '\n' ' ')"
  rm -f "$place.before"
}
# does WHAT_STDOUT_MUST_HOLD ARGUMENTS...
does() {
  local expected=$1; shift
  "$program" "$@" >stdout.txt 2>stderr.txt </dev/null
  local status=$?
  [ $status -eq 0 ] || fail "$* : status $status: $(head -c 600 stderr.txt)"
  grep -qF -- "$expected" stdout.txt || fail "$* : \"$expected\" is not in: $(head -c 600 stdout.txt)"
  [ ! -s stderr.txt ] || fail "$* : wrote to stderr: $(head -c 600 stderr.txt)"
  rm -f stdout.txt stderr.txt
}
