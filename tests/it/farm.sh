#!/bin/bash
# Starts a Slurm of one node for itself, without systemd, runs the README's array job on it, then its line for GNU
# parallel, and compares what both made with a direct export. Nothing is read or written outside of a temporary
# folder, and nothing is left running. Needs the Debian packages slurmctld slurmd slurm-client munge parallel.
# Usage: farm.sh GLINT FLIGHT.RON README.md
set -euo pipefail
glint=$(realpath "$1") scene=$(realpath "$2") readme=$(realpath "$3")
began=$(date +%s%N)
say() { printf '%5d ms  %s\n' $((($(date +%s%N) - began) / 1000000)) "$*"; }
until_true() {                                   # SECONDS COMMAND…
    local end=$((SECONDS + $1)); shift
    until "$@"; do [ $SECONDS -lt $end ] || { echo "never: $*" >&2; return 1; }; sleep 0.1; done
}

T=$(mktemp -d)                                   # short, for a path of a socket has at most 107 bytes
export PATH="$T/bin:$PATH:/usr/sbin" SLURM_CONF="$T/slurm.conf"
daemons=()
teardown() {
    status=$?; trap '' INT TERM; trap - EXIT; set +e
    [ $status = 0 ] || tail -n 15 "$T"/*.log "$T"/work/slurm-*.out >&2 2>/dev/null
    [ ${#daemons[@]} -lt 3 ] || scancel --quiet --me --signal=KILL --full 2>/dev/null
    for ((i = ${#daemons[@]} - 1; i >= 0; i--)); do kill "${daemons[i]}"; wait "${daemons[i]}"; done 2>/dev/null
    # What still runs was started with this configuration and no other: the slurmstepd of a task and what is below it.
    for environ in $(grep -lszxF "SLURM_CONF=$SLURM_CONF" /proc/[0-9]*/environ); do
        pid=${environ//[!0-9]/}
        [ "$pid" = $$ ] || kill -KILL "$pid" 2>/dev/null
    done
    rm -rf "$T" || { sleep 1; rm -rf "$T"; }
    exit $status
}
trap teardown EXIT; trap 'exit 130' INT; trap 'exit 143' TERM
chmod 755 "$T"                                   # munged refuses a socket that not everybody could reach
mkdir "$T"/{bin,state,spool,work}
cp "$glint" "$T/bin/glint"
cp "$scene" "$T/work/flight.ron"

# --- munged, with its own key and socket
head -c 1024 /dev/urandom > "$T/munge.key"; chmod 400 "$T/munge.key"
munged --foreground --key-file="$T/munge.key" --socket="$T/munge" --pid-file="$T/munged.pid" \
    --seed-file="$T/munge.seed" --num-threads=2 2> "$T/munged.log" & daemons+=($!)
until_true 10 test -S "$T/munge"

# --- one node with the cores there are; four tasks share a core, so that tasks run at the same time on any machine
port() {
    local p
    while p=$((20000 + RANDOM % 12000)); (: <>"/dev/tcp/127.0.0.1/$p") 2>/dev/null; do :; done
    echo $p
}
host=$(hostname -s) me=$(id -un)
cores=$(slurmd -C | grep -o 'CPUs=.*ThreadsPerCore=[0-9]*')
cat > "$SLURM_CONF" <<END
ClusterName=test
SlurmUser=$me
SlurmdUser=$me
AuthInfo=socket=$T/munge
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$(port)
SlurmdPort=$(port)
StateSaveLocation=$T/state
SlurmdSpoolDir=$T/spool
SlurmctldPidFile=$T/slurmctld.pid
SlurmdPidFile=$T/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
MailProg=/bin/true
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0
NodeName=$host NodeAddr=127.0.0.1 $cores
PartitionName=all Nodes=$host Default=YES OverSubscribe=FORCE:4
END
# Without this, slurmd of 22.05 looks for cgroups that it does not use, and ends where it finds none or version 2
# without systemd. `disabled` is what newer ones understand.
case $(slurmd -V) in
    *' 22.'*) printf 'CgroupPlugin=cgroup/v1\nCgroupMountpoint=%s/none\n' "$T" ;;
    *) echo CgroupPlugin=disabled ;;
esac > "$T/cgroup.conf"

slurmctld -D 2> "$T/slurmctld.log" & daemons+=($!)
slurmd -D 2> "$T/slurmd.log" & daemons+=($!)
is_idle() { [ "$(sinfo --noheader --format=%T 2>/dev/null)" = idle ]; }
until_true 30 is_idle
say "the node is idle: $cores"

# --- the lines of the README, with small frames
cd "$T/work"
small='glint export flight.ron --width 64 --height 48'
$small -o direct > /dev/null
say 'direct export'
notes() {  # what was noted of each frame, without the time it took; the last line about a file counts
    awk -F'\t' 'NF == 4 { note[$1] = $2 " " $3 } END { for (f in note) print f, note[f] }' "$1/glint-frames.txt" | sort
}
compare() {
    diff <(cd direct; sha256sum ./*.ppm) <(cd frames; sha256sum ./*.ppm)
    diff <(notes direct) <(notes frames)
    say "$1: $(ls frames/*.ppm | wc -l) frames and what was noted of them are those of the direct export"
    rm -r frames
}
line() { local line; line=$(grep "^$1" "$readme"); echo "${line/glint export flight.ron/$small}"; }

job=$(eval "$(line 'sbatch ' | sed 's/^sbatch /sbatch --parsable /')")
is_over() { local left; left=$(squeue --noheader --job="$job") && [ -z "$left" ]; }   # sooner than `sbatch --wait`
until_true 120 is_over
[ "$(scontrol --oneliner show job "$job" | grep -o ' JobState=[A-Z_]*' | sort | uniq -c | xargs)" = '21 JobState=COMPLETED' ]
compare sbatch

eval "$(line 'seq ')" > /dev/null
compare parallel
