# Lines that the commands print. Sourced by bash, never run.

say() { printf '%s\n' "== $*"; }
note() { printf '%s\n' "   $*"; }
warn() { printf '%s\n' "warning: $*" >&2; }
die() { printf '%s\n' "error: $*" >&2; exit 1; }
