# Runs a long job in stages, to be sourced: each stage says that it begins and, every half minute, how far it is; its output
# goes to build/log. After a failed stage the others go on, but those that need it. In the end one table.
#   stages TITLE COUNT                              before the first; COUNT is how many will come
#   stage NAME NEEDS REPEAT COMMAND [ARGUMENT...]   NEEDS: a stage that must have passed, or ""; REPEAT: a command that repeats it
#   stages_end                                      prints the table; fails where a stage did
# A command may write "passed failed skipped" to $stage_counts, and one line for each thing that failed to $stage_failed:
# what would repeat it.

stages() {
  stages_title=$1 stages_count=$2 stages_number=0 stages_failed=false stages_totals=(0 0 0) stages_table="" stages_repeat=""
  declare -gA stages_outcome=()
  stages_logs=build/log
  mkdir -p "$stages_logs"
}

stage() {
  local name=$1 needs=$2 repeat=$3 start=$SECONDS status=0 passed=- failed=- skipped=- took
  shift 3
  local log=$stages_logs/${name//[^A-Za-z0-9]/-}.log
  export stage_counts=$PWD/$log.counts stage_failed=$PWD/$log.failed  # commands may go elsewhere
  rm -f "$stage_counts" "$stage_failed"
  stages_number=$((stages_number + 1))
  if [ -n "$needs" ] && [ "${stages_outcome[$needs]:-}" != passed ]; then
    echo "$stages_title [$stages_number/$stages_count] $name: not run, it needs: $needs"
    stages_outcome[$name]=unrun
    stages_table+=$(printf '  %-26s %s' "$name" "not run")$'\n'
    return
  fi
  echo "$stages_title [$stages_number/$stages_count] $name"
  (while sleep 1; do
    [ $(((SECONDS - start) % 30)) -ne 29 ] || printf '    %4d s  %.100s\n' $((SECONDS - start)) "$(tail -n 1 "$log" | tr '\r' '\n' | tail -n 1)"
  done) &
  local heartbeat=$!
  set +e  # in a condition, errors within would not end the command
  (set -e; "$@") >"$log" 2>&1 </dev/null
  status=$?
  set -e
  kill "$heartbeat" 2>/dev/null
  wait "$heartbeat" 2>/dev/null || true
  took=$((SECONDS - start))
  if [ -s "$stage_counts" ]; then
    read -r passed failed skipped <"$stage_counts"
    stages_totals=($((stages_totals[0] + passed)) $((stages_totals[1] + failed)) $((stages_totals[2] + skipped)))
  fi
  stages_table+=$(printf '  %-26s %8s %7s %8s %6d s%s' "$name" "$passed" "$failed" "$skipped" "$took" \
    "$([ $status -eq 0 ] || echo '  FAILED')")$'\n'
  if [ $status -eq 0 ]; then
    stages_outcome[$name]=passed
    return
  fi
  stages_outcome[$name]=failed
  stages_failed=true
  stages_show "$log"
  stages_repeat+="$name ($log):"$'\n'
  if [ -s "$stage_failed" ]; then
    stages_repeat+=$(sed 's/^/  /' "$stage_failed")$'\n'
  else  # nothing tells what failed: how it ended
    stages_repeat+="  $repeat"$'\n'$(stages_show "$log" | tail -n 12)$'\n'
  fi
}

# What of a log tells why its stage failed: all but what passed, at most 200 lines of it.
stages_show() {
  grep -vE '^ *Start +[0-9]+:|Passed +[0-9.]+ sec$|^\[ +(RUN|OK) +\]|^\[[0-9]+/[0-9]+\] ' "$1" | tail -n 200 | sed 's/^/    | /' || true  # of an empty log nothing
}

stages_end() {
  printf '\n%s\n  %-26s %8s %7s %8s %8s\n%s' "$stages_title" stage passed failed skipped time "$stages_table"
  printf '%s: %d passed, %d failed, %d skipped\n' "${stages_title%% *}" "${stages_totals[@]}"
  if [ -n "${stages_note:-}" ]; then echo "$stages_note"; fi
  if $stages_failed; then
    printf '\n%s: failed; what repeats it:\n%s' "$stages_title" "$stages_repeat" >&2
    return 1
  fi
  echo "$stages_title: all passed"
}
