# SPDX-License-Identifier: GPL-3.0-or-later
# Sourced by the tests that run Python, after pipe.sh.

# python_with MODULE...: the first Python that has these modules, searched in RC_PYTHON, in PATH and in the
# system. Another Python on PATH does not see the packages of the system. If no Python has them, the reason
# goes to standard error.
python_with() {
    local modules python tried=(python3 /usr/bin/python3)
    [ -z "${RC_PYTHON-}" ] || tried=("$RC_PYTHON")
    modules=$(printf 'import %s; ' "$@")
    for python in "${tried[@]}"; do
        if "$python" -c "$modules" 2>python.err; then
            echo "$python"
            return
        fi
    done
    echo "$python without $*: $(tail -n 1 python.err)" >&2
    return 1
}
