# A Slurm cluster of two nodes on this machine, within a folder of its own; to be sourced by root.
# Sets SLURM_CONF, by which Slurm's commands find it.

# cluster_up FOLDER: which must be empty, and reachable by everybody
cluster_up() {
  local root=$1 here
  here=$(dirname "${BASH_SOURCE[0]}")
  mkdir "$root/state" "$root"/spool-w{1,2}
  local ports
  ports=($(free_ports 3))
  sed "s|@ROOT@|$root|g; s|@HOST@|$(hostname -s)|g
       s|@PORT0@|${ports[0]}|g; s|@PORT1@|${ports[1]}|g; s|@PORT2@|${ports[2]}|g" "$here/slurm.conf" >"$root/slurm.conf"
  export SLURM_CONF=$root/slurm.conf
  (umask 077 && head -c 128 /dev/urandom >"$root/munge.key")
  # --force: a key and a socket in a temporary folder are good enough here
  munged --force --key-file="$root/munge.key" --socket="$root/munge.socket" --pid-file="$root/munged.pid" \
    --log-file="$root/munged.log" --seed-file="$root/munge.seed" 2>"$root/munged.err" || { cat "$root/munged.err"; return 1; }
  slurmctld -f "$SLURM_CONF" || return
  node_up w1 && node_up w2 || return
  within 20 nodes_are_idle || { sinfo; tail "$root"/*.log; return 1; }
}

nodes_are_idle() { [ "$(sinfo -h -p work -t idle -o %D 2>/dev/null)" = 2 ]; }

node_up() { slurmd -f "$SLURM_CONF" -N "$1"; }

# node_dies NAME: as if it lost its power, with all that runs there
node_dies() {
  local root
  root=$(dirname "$SLURM_CONF")
  kill -KILL "$(cat "$root/$1.pid")" $(processes_on "$1")
  rm -f "$root/$1.pid"
}

# Slurm's processes that watch over a node's jobs, and what those have started.
processes_on() {
  local watcher script
  for watcher in $(pgrep -x slurmstepd); do
    has "$watcher" "SLURM_CONF=$SLURM_CONF" || continue
    for script in $(pgrep -P "$watcher"); do
      has "$script" "SLURMD_NODENAME=$1" && echo "$watcher" "$script" $(pgrep -P "$script")
    done
  done
}

# has PROCESS VARIABLE=VALUE
has() { grep -qzFx "$2" "/proc/$1/environ" 2>/dev/null; }

# Ends all of it, jobs included, whatever state it is in.
cluster_down() {
  local root=$1 file pids
  pids=$(cat "$root"/{w1,w2,slurmctld,munged}.pid; processes_on w1; processes_on w2) 2>/dev/null
  kill -KILL $pids 2>/dev/null
}

# within SECONDS COMMAND...: waits until it holds
within() {
  local end=$((SECONDS + $1))
  shift
  until "$@"; do
    [ "$SECONDS" -lt "$end" ] || return 1
    sleep 0.1
  done
}

# So many ports below those that systems hand out, on which nobody listens.
free_ports() {
  local port
  for port in $(shuf -i 20000-30000 -n 100); do
    (: <"/dev/tcp/127.0.0.1/$port") 2>/dev/null || echo "$port"
  done | head -n "$1"
}
