//! Cubics as eases: for formats in which a curve runs from one value to another, 0 to 1.

use crate::curve::{Between, Curve};

/// One axis from one value to the next, along a cubic Bézier curve whose handles stand at a third
/// and two thirds of the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ease {
    /// The times of the ends, in s.
    pub(crate) t: [f64; 2],
    pub(crate) value: [f64; 2],
    /// The progress of the two handles; `None` where the value is held.
    pub(crate) handles: Option<[f64; 2]>,
}

/// The eases of one axis. A cubic is parted where it turns back: an ease that ends where it began
/// has no room to move.
pub(crate) fn eases(curve: &Curve, axis: usize) -> Vec<Ease> {
    let mut eases = Vec::new();
    for pair in curve.keys.windows(2) {
        let (a, b) = (&pair[0], &pair[1]);
        let (t, h) = ([a.t, b.t], b.t - a.t);
        let value = [a.place[axis], b.place[axis]];
        match curve.between {
            Between::Hold => eases.push(Ease { t, value, handles: None }),
            Between::Line => eases.push(Ease { t, value, handles: Some([1.0 / 3.0, 2.0 / 3.0]) }),
            Between::Cubic => {
                let (v, w) = (h * a.leave[axis], h * b.enter[axis]);
                let d = value[1] - value[0];
                // p + v u + m u² + n u³
                let c = [value[0], v, 3.0 * d - 2.0 * v - w, v + w - 2.0 * d];
                let mut cuts = vec![0.0];
                cuts.extend(turns(c));
                cuts.push(1.0);
                for cut in cuts.windows(2) {
                    eases.push(piece(c, [cut[0], cut[1]], t[0], h, value));
                }
            }
        }
    }
    eases
}

/// The least and the greatest value of one axis of a curve.
pub(crate) fn extremes(curve: &Curve, axis: usize) -> [f64; 2] {
    // A cubic that is parted where it turns back is extreme at the ends of its parts.
    let ends = eases(curve, axis).into_iter().flat_map(|ease| ease.value);
    ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], value| [least.min(value), most.max(value)])
}

/// The extremes of the cubic inside (0, 1), in order.
fn turns([_, v, m, n]: [f64; 4]) -> Vec<f64> {
    let size = v.abs().max(m.abs()).max(n.abs());
    let (a, b) = (3.0 * n, 2.0 * m);
    let roots = if a.abs() <= 1e-9 * size {
        vec![-v / b]
    } else {
        let root = (b * b - 4.0 * a * v).sqrt();
        let q = -0.5 * (b + root.copysign(b));
        vec![q / a, v / q]
    };
    let mut roots: Vec<f64> = roots.into_iter().filter(|u| *u > 1e-6 && *u < 1.0 - 1e-6).collect();
    roots.sort_by(f64::total_cmp);
    roots
}

fn piece([p, v, m, n]: [f64; 4], [from, to]: [f64; 2], start: f64, h: f64, ends: [f64; 2]) -> Ease {
    let at = |u: f64| p + u * (v + u * (m + u * n));
    let slope = |u: f64| v + u * (2.0 * m + 3.0 * u * n);
    // Keys keep their values to the last digit.
    let value = [if from == 0.0 { ends[0] } else { at(from) }, if to == 1.0 { ends[1] } else { at(to) }];
    let (d, third) = (value[1] - value[0], (to - from) / 3.0);
    let still = d.abs() <= 1e-12 * value[0].abs().max(value[1].abs()).max(1e-3);
    let handles = [slope(from) * third / d, 1.0 - slope(to) * third / d];
    Ease { t: [start + h * from, start + h * to], value, handles: (!still).then_some(handles) }
}
