//! A fitted recording in the table's own units.

use super::{Candidates, Choice, Scale};
use crate::finding::FindingKind;
use crate::model::{Dual, FLOOR, GRAVITY, Law, Trajectory};
use crate::quantity::Measured;
use crate::solve::choice::of_recording;
use crate::solve::series::recording::{Course, Impact, Track, Variant};

impl Candidates {
    /// What was left out.
    pub(crate) fn repairs(&self) -> Vec<FindingKind> {
        let (before, after) = self.left_out;
        let ends = FindingKind::EndsLeftOut { before, after, brief: self.brief };
        let wild = FindingKind::WildLeftOut { samples: self.wild };
        [(before + after > 0, ends), (self.wild > 0, wild)]
            .into_iter()
            .filter(|(any, _)| *any)
            .map(|(_, kind)| kind)
            .collect()
    }

    /// The recording under the chosen model, in the table's units.
    pub(crate) fn track(&self, choice: Choice) -> Option<Track> {
        let single = self.sketch.contacts.len() == 1;
        let (law, drag) = if single { (Law::Constant, choice.1) } else { choice };
        let of = |choice: Choice| self.found.iter().find(|f| f.choice == choice);
        let each = if single { (Law::Constant, drag) } else { (Law::Each, drag) };
        let chosen = of((law, drag)).or_else(|| of((law, false))).or(self.found.first())?;
        // Impact by impact, whatever the law.
        let own = of(each).unwrap_or(chosen);
        let Scale { origin, unit, range } = self.scale;
        let model = self.model(&self.samples, own.choice);
        let impacts = model.impacts(&own.fitted.shared);
        let impacts: Vec<Impact> = impacts
            .iter()
            .enumerate()
            .map(|(n, i)| Impact {
                bounce: n + 1,
                time: origin.0 + unit * i.time.value,
                speed: i.arrival.value * range / unit,
                cor: self.measured(own, &i.cor),
            })
            .collect();
        let values = &chosen.fitted.shared;
        let model = self.model(&self.samples, chosen.choice);
        let unknown = |j: usize, scale: f64, shift: f64| {
            let m = self.measured(chosen, &Dual::unknown(values[j], values.len(), j));
            Measured { value: shift + scale * m.value, standard_error: scale * m.standard_error }
        };
        let turn = if self.turned { -1.0 } else { 1.0 };
        let floor = unknown(FLOOR, range, origin.1);
        let left = self.left(values, chosen.choice);
        let rms = range * (left.iter().map(|r| r * r).sum::<f64>() / left.len() as f64).sqrt();
        let course = self.course(&model, values, &left);
        Some(Track {
            trial: self.trial,
            samples: self.samples.len(),
            left_out: [self.left_out.0, self.left_out.1, self.wild],
            impacts,
            gravity: unknown(GRAVITY, range / (unit * unit), 0.0),
            drag: model.drag_place().map(|j| unknown(j, 1.0 / range, 0.0)),
            drift: model
                .drift_place()
                .map(|j| unknown(j, range / unit, 0.0))
                .map(|d| Measured { value: turn * d.value, ..d }),
            contact: model.contact_place().map(|j| unknown(j, unit, 0.0)),
            floor: Measured { value: turn * floor.value, ..floor },
            rms,
            noise: range * self.noise,
            models: self.variants(),
            unseen: self.unseen(chosen),
            reach: self.misfit(chosen, &left),
            free_drag: self.free_drag(),
            course,
        })
    }

    /// The motion that was fitted, in the table's units.
    fn course(&self, model: &Trajectory<'_>, values: &[f64], left: &[f64]) -> Course {
        let Scale { origin, unit, range } = self.scale;
        let fitted = model.impacts(values);
        Course {
            contacts: fitted.iter().map(|i| origin.0 + unit * i.time.value).collect(),
            lasting: fitted.iter().map(|i| unit * i.lasts.as_ref().map_or(0.0, |lasts| lasts.value)).collect(),
            apexes: model
                .apexes(values)
                .iter()
                .map(|(t, h)| (origin.0 + unit * t, range * (h - values[FLOOR])))
                .collect(),
            gravity: values[GRAVITY] * range / (unit * unit),
            drag: model.air(values).drag / range,
            samples: self
                .samples
                .iter()
                .zip(left)
                .map(|(s, r)| {
                    let floor = values[FLOOR] + model.drift_place().map_or(0.0, |j| values[j] * s.time);
                    (origin.0 + unit * s.time, range * (s.height - floor), range * r)
                })
                .collect(),
        }
    }

    fn variants(&self) -> Vec<Variant> {
        let least = self.found.iter().map(|f| f.bic).fold(f64::INFINITY, f64::min);
        let mut list: Vec<Variant> = self
            .found
            .iter()
            .map(|f| {
                let left = self.left(&f.fitted.shared, f.choice);
                Variant {
                    law: of_recording(f.choice.0, false),
                    drag: f.choice.1,
                    unknowns: self.unknowns(f),
                    rms: self.scale.range * (left.iter().map(|r| r * r).sum::<f64>() / left.len() as f64).sqrt(),
                    bic: f.bic - least,
                    cor: f.cor,
                }
            })
            .collect();
        list.sort_by(|a, b| a.bic.total_cmp(&b.bic));
        list
    }
}
