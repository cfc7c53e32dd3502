# The native tests as a stage, to be sourced after stages.sh from the root of the project.

jobs=${KNEAD_JOBS:-$(nproc)}
results=$PWD/build/log
mkdir -p "$results"

# Counts them, and says for each that failed what repeats it. Results stay in build/log/NAME.xml.
native_tests() {  # native_tests NAME [options of ctest...]
  local xml=$results/$1.xml status=0
  shift
  rm -f "$xml"
  ctest --preset release -j "$jobs" --output-junit "$xml" "$@" || status=$?
  [ -f "$xml" ] || return 1
  awk '
    /^<testsuite / || /^\t(tests|failures|disabled|skipped)=/ {
      while (match($0, /(tests|failures|skipped)="[0-9]+"/)) {
        split(substr($0, RSTART, RLENGTH), pair, /="|"/); count[pair[1]] = pair[2]; $0 = substr($0, RSTART + RLENGTH)
      }
    }
    END { print count["tests"] - count["failures"] - count["skipped"], count["failures"], count["skipped"] }' "$xml" >"$stage_counts"
  sed -n 's/.*<testcase name="\([^"]*\)".*status="fail".*/\1/p' "$xml" | unescaped |
    sed 's/[.[\*^$()+?{|]/\\&/g; s/.*/ctest --preset release --output-on-failure -R '"'^&\$'"'/' >"$stage_failed"
  return $status
}
unescaped() { sed 's/&quot;/"/g; s/&apos;/'"'"'/g; s/&lt;/</g; s/&gt;/>/g; s/&amp;/\&/g'; }
