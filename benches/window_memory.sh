#!/usr/bin/env bash
# The memory of the window in use, on a display without a screen: window_memory.sh PROGRAM SECONDS [still]
#
# Prints the seconds, the resident memory in MB and the processor time in seconds, every 30 seconds. The window is worked by a script that walks along the front,
# changes dimensions, heatmaps, views and panels; with `still`, it draws frames of one design.
set -euo pipefail

program=$1
seconds=$2
work="$(mktemp -d)"
trap 'rm -rf "$work"' EXIT
export XDG_RUNTIME_DIR="$work" XDG_DATA_HOME="$work"

fields=(k_xy k_z inverse_condition displacement)
views=(oblique top front side)
panels=(Front Prices Compare Strength Pose Layers Drivers)
{
    printf 'wait finished\nchoose knee\nwait drawn\n'
    if [ "${3:-}" = still ]; then
        echo 'wait frames 100000000'
    else
        # A sequence that repeats itself after thousands of steps.
        for ((step = 1; step <= 20000; step++)); do
            case $((step * step % 11)) in
                0) printf 'choose knee\nwait drawn\n' ;;
                1) printf 'walk %d\nwait drawn\n' $((step % 9 - 4)) ;;
                3) printf 'what-if rj=0.0%d\nwait drawn\n' $((20 + step % 30)) ;;
                4) printf 'heatmap %s\nwait drawn\n' "${fields[step % 4]}" ;;
                5) echo "look ${views[step % 4]}" ;;
                *) echo "show ${panels[step % 7]}" ;;
            esac
            echo "wait frames $((5 + step % 3 * 5))"
        done
    fi
    echo quit
} >"$work/script.txt"

xvfb-run --auto-servernum --server-args="-screen 0 1600x1000x24" "$program" explore paper --script "$work/script.txt" &
display=$!
for ((passed = 30; passed <= seconds; passed += 30)); do
    sleep 30
    window="$(pgrep -f "^$program explore" | head -n 1)"
    awk -v passed="$passed" -v ticks="$(getconf CLK_TCK)" \
        'FILENAME ~ /status/ && /VmRSS/ { memory = $2 / 1024 } FILENAME ~ /stat$/ { time = ($14 + $15) / ticks } END { print passed, memory, time }' \
        "/proc/$window/status" "/proc/$window/stat"
done
pkill -f "^$program explore"
wait "$display" || true
