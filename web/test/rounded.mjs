// Tables of which the page's report is not the tool's to 1e-9.
//
// The fit's own logarithms, powers and angles are one library's on every machine. What is left is
// `hypot` in the singular values of nalgebra, which is the system's: its last bit moves where the
// solver stops. With one `hypot` in both, all reports are equal to 1e-9.

export const NEAR = ["capstone.csv", "pupil-b-tracker-two.txt", "pupil-c-logger-pro.txt", "trap-f-r1-radius.csv", "uncal-video.csv"];

/// How far apart their numbers may be, as a part of themselves; 2e-7 is the most that was seen.
export const LEFT = 1e-6;
