#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Predicts the seconds of a periodic contact on several machines from the time on one: plan.sh strong|weak.
#
#   seconds of one convolution's share = C log2(n)/log2(n0) n^2/M      n x n nodes, M machines
#     + bytes/bandwidth + messages latency                             two exchanges of 16 n^2/2 bytes
#     + sums latency log2 M
#
# C n0^2: seconds of one equivalent at n0 x n0 on one machine, including all other work of the iteration. The
# environment sets C (1.1e-8 s a node), N0 (4096), BANDWIDTH (12.5e9 bytes/s a machine) and LATENCY (2e-6 s).
# It also sets SUMS (25 an equivalent) and EQUIVALENTS (20 a contact).
case ${1-} in
strong | weak) ;;
*)
    echo "usage: plan.sh strong|weak" >&2
    exit 2
    ;;
esac
awk -v kind="$1" -v C="${C:-1.1e-8}" -v n0="${N0:-4096}" -v B="${BANDWIDTH:-12.5e9}" \
    -v L="${LATENCY:-2e-6}" -v sums="${SUMS:-25}" -v E="${EQUIVALENTS:-20}" 'BEGIN {
    OFS = "\t"
    print "machines", "compute/s", "network/s", "total/s", "ideal/s", "memory/B"
    for (M = 1; M <= 1024; M *= 2) {
        n = kind == "weak" ? 8192 * sqrt(M) : 65536
        compute = E * C * n * n / M * log(n) / log(n0)
        network = M == 1 ? 0 : E * (16 * n * n / M * (1 - 1 / M) / B + 2 * (M - 1) * L + sums * L * log(M) / log(2))
        if (M == 1) ideal = compute
        print M, compute, network, compute + network, kind == "weak" ? ideal : ideal / M, 83 * n * n / M
    }
}'
