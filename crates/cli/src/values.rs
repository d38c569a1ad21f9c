//! Values of flags, checked while the command line is read, before anything runs or is written.

use std::fmt;
use std::str::FromStr;

/// A duration in seconds: finite and not negative.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seconds(pub f64);

impl FromStr for Seconds {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let seconds: f64 = text
            .parse()
            .map_err(|_| "not a number of seconds".to_owned())?;
        if !seconds.is_finite() {
            return Err("not a finite number of seconds".to_owned());
        }
        if seconds < 0.0 {
            return Err("a time below 0 s".to_owned());
        }
        Ok(Self(seconds))
    }
}

/// `KEY=VALUE`.
#[derive(Clone, Debug, PartialEq)]
pub struct KeyValue {
    /// What stands before the first `=`.
    pub key: String,
    /// What stands after it.
    pub value: String,
}

impl FromStr for KeyValue {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.split_once('=') {
            Some((key, value)) if !key.trim().is_empty() => Ok(Self {
                key: key.trim().to_owned(),
                value: value.trim().to_owned(),
            }),
            _ => Err("not of the form KEY=VALUE".to_owned()),
        }
    }
}

/// Slice `index` (from 0) of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which one, from 0.
    pub index: u64,
    /// Of how many.
    pub count: u64,
}

impl Shard {
    /// All in one.
    pub const WHOLE: Self = Self { index: 0, count: 1 };

    /// What of `all` frames or runs is this slice's: slices are contiguous and differ by at most one.
    pub const fn range(self, all: u64) -> std::ops::Range<u64> {
        // At most 1e9 runs and 1e6 slices: no overflow.
        self.index * all / self.count..(self.index + 1) * all / self.count
    }
}

/// `I/N`, counted from 1.
impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index + 1, self.count)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once('/').and_then(|(index, count)| {
            Some((index.parse::<u64>().ok()?, count.parse::<u64>().ok()?))
        });
        match numbers {
            Some((index, count)) if (1..=count).contains(&index) && count <= 1_000_000 => {
                Ok(Self {
                    index: index - 1,
                    count,
                })
            }
            Some((index, count)) => Err(format!("slice {index} of {count} does not exist")),
            None => Err("not of the form I/N".to_owned()),
        }
    }
}

/// `WIDTHxHEIGHT` in pixels; the limits are the renderer's.
pub fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text
        .split_once(['x', 'X'])
        .and_then(|(width, height)| Some((width.parse().ok()?, height.parse().ok()?)));
    let (width, height) = sides.ok_or("not of the form WxH, such as 800x600")?;
    carom_render::Size::new(width, height).map_err(|error| error.to_string())?;
    Ok((width, height))
}

/// Frames per second; the limits are the renderer's.
pub fn parse_rate(text: &str) -> Result<u32, String> {
    let rate = text
        .parse()
        .map_err(|_| "not a whole number of frames per second".to_owned())?;
    carom_render::FrameRate::per_second(rate).map_err(|error| error.to_string())?;
    Ok(rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_cover_every_frame_once() {
        for (frames, count) in [(600, 1), (600, 7), (3, 5), (0, 2)] {
            let slices = (0..count).flat_map(|index| Shard { index, count }.range(frames));
            assert!(slices.eq(0..frames), "{frames} frames in {count} slices");
        }
    }

    #[test]
    fn wrong_values_are_named() {
        for (text, why) in [
            ("nan", "finite"),
            ("-1", "below 0"),
            ("1e999", "finite"),
            ("x", "not a number"),
        ] {
            let error = text.parse::<Seconds>().unwrap_err();
            assert!(error.contains(why), "{text}: {error}");
        }
        for text in ["0/3", "4/3", "1/0", "1", "a/b", "-1/3"] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
        for text in ["0x600", "800", "800x", "100000x100000", "-1x5"] {
            assert!(parse_size(text).is_err(), "{text}");
        }
        for text in ["0", "-1", "1001", "nan", "29.97", "1000000000"] {
            assert!(parse_rate(text).is_err(), "{text}");
        }
        for text in ["", "n", "=3"] {
            assert!(text.parse::<KeyValue>().is_err(), "{text}");
        }
    }
}
