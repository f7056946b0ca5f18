#!/usr/bin/env python3
"""Our time for a slab over that of other programs: slab_peers.py BENCH_PP_SOLVER flux|radiance [N,N,...] [ROUNDS]

BENCH_PP_SOLVER is build/release/bench/bench_pp_solver. Peers are the Python packages disortpp and nanodisort, as far as
this Python has them; they are no part of Sunfleck. The problem is that of the benchmarks `flux` and `radiance`: g .85,
omega .99, thickness 10, mu0 .5; radiance in 6 directions at 3 depths with corrections. Ours and theirs take turns, one
thread each; the ratio is the median over the rounds of ours over the fastest of theirs in the same round.
"""
import json
import os
import statistics
import subprocess
import sys
import time

os.environ.update(OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1")  # before a peer starts its threads

ASYMMETRY, ALBEDO, THICKNESS, MU0 = 0.85, 0.99, 10.0, 0.5
REFLECTANCE, TRANSMITTANCE = 0.51608139149, 0.31244231475  # as in bench_pp_solver.cpp
UPWARD = [-1.0, -0.5, -0.1, 0.1, 0.5, 1.0]  # cosines as the peers have them
DEPTHS = [0.0, 0.5 * THICKNESS, THICKNESS]
MOMENTS = 300  # of the phase function, where radiance is corrected by the whole of it
SECONDS = 0.3  # of each program in each round


def disortpp_flux(disortpp, streams, radiance):
    if radiance or streams > 64:  # what its flux solver takes
        return None
    config = disortpp.DisortFluxConfig(1, streams)
    config.allocate()
    config.delta_tau, config.single_scat_albedo = [THICKNESS], [ALBEDO]
    config.set_henyey_greenstein(ASYMMETRY)
    config.direct_beam_flux, config.direct_beam_mu, config.surface_albedo = 1.0, MU0, 0.0
    return lambda solver=disortpp.create_flux_solver(streams): solver.solve(config), lambda r: (
        r.flux_up[0], r.flux_down[-1] + r.flux_direct_beam[-1])


def disortpp(disortpp, streams, radiance):
    config = disortpp.DisortConfig(1, streams, MOMENTS if radiance else streams)
    flags = config.flags
    flags.use_lambertian_surface, flags.comp_only_fluxes, flags.use_user_tau = True, not radiance, True
    depths = DEPTHS if radiance else [0.0, THICKNESS]
    config.num_user_tau = len(depths)
    if radiance:
        flags.use_user_mu, config.num_user_mu, config.num_phi = True, len(UPWARD), 1
        flags.intensity_corr_nakajima = flags.intensity_corr_buras = True  # either alone changes nothing
    config.allocate()
    config.delta_tau, config.single_scat_albedo, config.tau_user = [THICKNESS], [ALBEDO], depths
    config.set_henyey_greenstein(ASYMMETRY)
    if radiance:
        config.mu_user, config.phi_user = UPWARD, [0.0]
    config.bc.direct_beam_flux, config.bc.direct_beam_mu, config.bc.direct_beam_phi = 1.0, MU0, 0.0
    config.bc.surface_albedo = 0.0
    return lambda solver=disortpp.DisortSolver(): solver.solve(config), lambda r: (
        r.flux_up[0], r.flux_down[-1] + r.flux_direct_beam[-1])


def nanodisort(nanodisort, streams, radiance):
    import numpy
    state = nanodisort.DisortState()
    depths = DEPTHS if radiance else [0.0, THICKNESS]
    state.nstr = state.nphase = streams
    state.nlyr, state.nphi, state.ntau = 1, 1, len(depths)
    state.nmom = MOMENTS if radiance else streams
    state.numu = len(UPWARD) if radiance else streams
    state.usrtau = state.lamber = state.quiet = state.old_intensity_correction = True
    state.usrang, state.onlyfl, state.intensity_correction = radiance, not radiance, radiance
    state.planck = state.spher = False
    state.allocate()
    state.dtauc, state.ssalb = numpy.array([THICKNESS]), numpy.array([ALBEDO])
    state.pmom = (ASYMMETRY ** numpy.arange(state.nmom + 1)).reshape(-1, 1)
    state.utau, state.phi = numpy.array(depths), numpy.array([0.0])
    if radiance:
        state.umu = numpy.array(UPWARD)
    state.fbeam, state.umu0, state.phi0, state.albedo, state.fisot, state.accur = 1.0, MU0, 0.0, 0.0, 0.0, 0.0
    return lambda: state.solve() or state, lambda s: (s.flup[0], s.rfldn[-1] + s.rfldir[-1])


def importable_peers():
    for name, programs in (("disortpp", [disortpp_flux, disortpp]), ("nanodisort", [nanodisort])):
        try:
            module = __import__(name)
        except ImportError:
            print(f"no {name}: install the Python package to compare with it", file=sys.stderr)
            continue
        yield from ((program.__name__, program, module) for program in programs)


def peer_seconds(solve):
    times, start = [], time.perf_counter()
    while time.perf_counter() - start < SECONDS or len(times) < 3:
        before = time.perf_counter()
        solve()
        times.append(time.perf_counter() - before)
    return statistics.median(times)


def our_seconds(bench, what, streams):
    out = subprocess.run([bench, f"--benchmark_filter=^{what}/N:{streams}$", "--benchmark_format=json",
                          f"--benchmark_min_time={SECONDS}"], capture_output=True, text=True, check=True).stdout
    run, = json.loads(out)["benchmarks"]
    if run.get("error_occurred"):
        sys.exit(f"{what} N = {streams}: {run['error_message']}")
    return run["cpu_time"] * {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}[run["time_unit"]]


def main():
    if len(sys.argv) < 3 or sys.argv[2] not in ("flux", "radiance"):
        sys.exit(__doc__)
    bench, what = sys.argv[1:3]
    sizes = sys.argv[3] if len(sys.argv) > 3 else "4,8,16,32,64,128" if what == "flux" else "16,32,64"
    rounds = int(sys.argv[4]) if len(sys.argv) > 4 else 5
    peers = list(importable_peers())
    if not peers:
        sys.exit(1)
    for streams in map(int, sizes.split(",")):
        solves = {}
        for name, make, module in peers:
            made = make(module, streams, what == "radiance")
            if made is None:
                continue
            solve, fluxes = made
            up, down = fluxes(solve())
            if max(abs(up / MU0 - REFLECTANCE), abs(down / MU0 - TRANSMITTANCE)) > 0.08 / streams**2:
                print(f"{name} N = {streams}: wrong answer, left out", file=sys.stderr)
                continue
            solves[name] = solve
        ours, theirs = [], []
        for _ in range(rounds):
            ours.append(our_seconds(bench, what, streams))
            theirs.append(min((peer_seconds(solve), name) for name, solve in solves.items()))
        ratio = statistics.median(a / b for a, (b, _) in zip(ours, theirs))
        print(f"{what} N = {streams}: ratio {ratio:.2f}, ours {1e6 * statistics.median(ours):.3g} us, "
              f"{statistics.mode(name for _, name in theirs)} {1e6 * statistics.median(b for b, _ in theirs):.3g} us",
              flush=True)


if __name__ == "__main__":
    main()
