"""Data for honest tests of discovery, from a truth that shares nothing with the estimator.

Two simulators stand here; both use the simulated rig's geometry and six-coordinate Newton, and import nothing of the
engine or of what is built on it.

`hexdbb_truth.cases`: mechanisms of the rig, whose forms are the catalogue's, stepped through time.

`hexdbb_truth.forms`: faults with forms of their own, as real machines have them. A case is told by its name:

    from hexdbb_truth.forms.cases import case
    from hexdbb_truth.forms.lists import alone, outside, combined, clean, reachable

    one = case("backlash-d10-x3-judge-s7")
    one.record()       a hexdbb Record of about 10,000 readings; one.write(folder) writes the text form
    one.labels         the truth: kind, port, elements (from 1; () for all alike or a port of one), variables,
                       stated equivalents with their reasons
    one.hidden         besides that the size, its unit, and the name of the form
    one.deviations()   the form deviation as measured at the port
    one.shown_deviation()   what of it shows in the readings once geometry and set-up are fitted

    backlash-d10-x3-judge-s7             form deviation 10 %, 3 times the noise, judging half, seed 7
    backlash+bar_drift-d10-x3-judge-s0   a pair (triples and more alike)
    dent-d0-x10-judge-s2                 a fault outside the catalogue (`hexdbb_truth.forms.outside`)
    chords_for_arc-d0-x3-judge-s0        alike, of a kind in lists only on demand (`forms.outside.BY_NAME_ONLY`)
    none-judge-s4                        a clean machine
    ...@varied                           another plan (`hexdbb_truth.forms.plans`)

- `d`: share of the fault's effect at its port that is not the catalogue's formula, root mean square over the samples,
  what geometry can do at that port left aside. 0, 5, 10, 20 %.
- `x`: root mean square that remains of the noise-free readings when the 33 errors of geometry, cups and ball have been
  fitted with the priors of a new model, over the gauge's noise; of several faults, each as if it were alone.
  1.5, 3, 10, 30, 100. Where no machine in use has a fault so large, asking for what is hidden (or the record) raises
  `UnreachableSizeError`; `reachable(cases)` leaves such cases out.
- `calibrate` and `judge`: halves with disjoint families of strange forms, other machines, other draws. Criteria are set
  on the first and judged on the second.
- Leave one out: any case of `alone` with its effect withheld from the candidates; the labels' equivalents tell what
  else may be named.

    for one in reachable(alone("calibrate", kinds=["straightness"], seeds=range(3))): ...

A case with its record takes 0.5 s of one core (median; 5 s for bar_drift, whose geometry bends far). Set
OMP_NUM_THREADS=1: with two threads on its small matrices the same takes five times as long.
"""
