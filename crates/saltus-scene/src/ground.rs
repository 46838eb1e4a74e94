//! Names of balls and the outline of what they bounce on.

use crate::{Floor, Scene, Shape};

/// More steps than can be told apart.
const MOST: u32 = 2000;

impl Scene {
    /// What a ball is called, counted from 0: its name, or its number.
    #[must_use]
    pub fn ball_name(&self, ball: usize) -> String {
        let name = self.balls.get(ball).and_then(|ball| ball.name.clone());
        name.unwrap_or_else(|| format!("ball {}", ball + 1))
    }
}

impl Floor {
    /// The corners, in x and up, of a floor or wall that has any, within `[[left, right], [low, high]]`; none of one across y or of a curve.
    #[must_use]
    pub fn corners(&self, [[left, right], [low, high]]: [[f64; 2]; 2]) -> Vec<[f64; 2]> {
        match self.shape {
            Shape::Level { height } => vec![[left, height], [right, height]],
            Shape::Incline { angle, height } => [left, right].map(|x| [x, height + x * angle.tan()]).to_vec(),
            Shape::Wall { across_y: false, at, .. } => vec![[at, low], [at, high]],
            Shape::Box { size, height, open } => {
                let (x, top) = (0.5 * size.x, height + size.z);
                let mut corners = vec![[-x, top], [-x, height], [x, height], [x, top]];
                corners.extend((!open).then_some([-x, top]));
                corners
            }
            Shape::Stairs { top, from, tread, rise, count } => {
                let mut corners = vec![[left.min(from), top]];
                let steps = (0..count.unwrap_or(MOST).min(MOST)).map(f64::from);
                for step in steps.take_while(|step| from + tread * step <= right) {
                    let edge = from + tread * step;
                    corners.extend([[edge, top - rise * step], [edge, top - rise * (step + 1.0)]]);
                }
                let level = corners.last().map_or(top, |corner| corner[1]);
                corners.push([right, level]);
                corners
            }
            _ => Vec::new(),
        }
    }
}
