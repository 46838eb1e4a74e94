//! What formats have of their own: a unit of length, an axis that is up.

use super::{ExportError, Format};
use crate::space::{Space, Unit, Up};

impl Format {
    /// The reason why its lengths are in metres, or have no unit at all; `None` where they can be
    /// in any.
    const fn unit_is_own(self) -> Option<&'static str> {
        match self {
            Self::Csv
            | Self::CsvFrames
            | Self::Contacts
            | Self::Usd
            | Self::UsdSplines
            | Self::Usdz
            | Self::Blender
            | Self::Maya => None,
            Self::Glb | Self::Gltf => Some("glTF is in metres by its specification"),
            Self::Json => Some("its lengths are metres by its contract"),
            Self::Lottie | Self::DotLottie | Self::Svg | Self::Chart | Self::Html => {
                Some("a picture has the size of its page, and no unit")
            }
            Self::Wav => Some("a sound has no lengths"),
        }
    }

    /// The axis that is up, and why; `Ok` where it can be either.
    const fn up_is_own(self) -> Result<(), (Option<Up>, &'static str)> {
        Err(match self {
            Self::Usd | Self::UsdSplines | Self::Usdz => return Ok(()),
            Self::Glb | Self::Gltf => (Some(Up::Y), "in glTF y is up by its specification"),
            Self::Blender => (Some(Up::Z), "in Blender z is always up"),
            Self::Maya => (Some(Up::Y), "in Maya it is a setting of the program, which a script should leave alone"),
            Self::Csv | Self::CsvFrames | Self::Contacts | Self::Json => {
                (None, "its numbers go by the names x, y and height or up, whichever axis they become")
            }
            Self::Lottie | Self::DotLottie | Self::Svg | Self::Chart | Self::Html => {
                (None, "a picture is upright, and has no such axis")
            }
            Self::Wav => (None, "a sound has no axes"),
        })
    }

    /// Whether files of it can have a unit and an axis.
    ///
    /// # Errors
    /// [`ExportError`] if not, with the reason.
    ///
    /// ```
    /// use saltus_motion::{Format, Space, Unit, Up};
    /// let space = Space { unit: Unit::Inch, up: Some(Up::Z) };
    /// assert!(Format::Usdz.takes(space).is_ok());
    /// assert!(Format::Glb.takes(space).is_err_and(|error| error.to_string().contains("glTF is in metres")));
    /// ```
    pub fn takes(self, space: Space) -> Result<(), ExportError> {
        let name = self.name();
        if let Some(why) = self.unit_is_own().filter(|_| space.unit != Unit::Metre) {
            let unit = space.unit.symbol();
            return Err(ExportError(format!(
                "{name} cannot be in {unit}: {why}; leave out the unit, or write usd, blender, maya or csv"
            )));
        }
        match (space.up, self.up_is_own()) {
            (Some(up), Err((own, why))) if own != Some(up) => Err(ExportError(format!(
                "{name} cannot have {} up: {why}; leave out the axis, or write usd",
                up.name()
            ))),
            _ => Ok(()),
        }
    }
}
