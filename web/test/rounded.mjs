// Tables of which the page's report is not the tool's to 1e-9: a browser's logarithms differ from
// the system's in the last bit. Verdicts are the same in all of them.

/// Numbers at which the solver stops a little earlier or later, or that are what rounding leaves of
/// nothing: the text of the report is the same.
export const NEAR = [
  "32-phyphox-screen.csv", "avg-only.csv", "capstone-tab.txt", "capstone.csv", "detector-above.txt", "mtrackj.txt", "negative.csv",
  "rebound-per-floor.csv", "tracker.txt", "trap-f-r1-radius.csv", "two-runs.txt", "typed-4-t-y.csv", "typed-8-LoggerPro.txt",
  "typed-blank-rows.csv", "typed-median-min-max.csv", "typed-mixed-lost-kept.csv", "typed-peaks-times.csv", "typed-range-cells.csv", "vernier.csv",
];

/// What rounding decides in the fit, and should not.
export const DECIDED = {
  // Two models explain the readings equally well, and stand in either order.
  order: [
    "bbcode.txt", "letters-for-digits.txt", "quantities-units.csv", "remark-under-names.csv", "typed-6-app.json", "typed-repeats-rows.csv",
    "xialuo.csv",
  ],
  // Trials that agree exactly: how many move the fit is counted by differences from 0.
  trials: ["thousand-mm.csv", "trap-h-slope.csv"],
  // A model that the readings do not determine has any COR.
  undetermined: ["typed-apex.csv", "typed-hmax-tmax.csv"],
  // A trend through readings without scatter is beyond chance, or not there.
  exact: ["typed-essais.csv"],
  // The interval of the COR takes in one explanation more or less.
  interval: ["typed-3-18.csv"],
};
