//! EXR files as this bench writes and reads them: one picture of named channels and, where it has one, a text that
//! tells where it comes from.

use crate::scene::Rgb;
use exr::meta::MetaData;
use exr::meta::header::Header;
use exr::prelude::{
    AnyChannel, AnyChannels, AttributeValue, Encoding, FlatSamples, Image, Layer, LayerAttributes,
    ReadChannels, ReadLayers, SmallVec, Text, WritableImage, read,
};
use std::io::Cursor;

/// Why a file is no reference.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BadReference {
    /// Not an EXR, damaged, or cut off.
    #[error("it cannot be read as OpenEXR ({0}); is it whole, and an EXR at all?")]
    Unreadable(String),
    /// More than one picture.
    #[error("it holds {0} pictures; a reference is one, of the channels R G B and std_error.R G B")]
    Pictures(usize),
    /// Channels that nobody would look at.
    #[error(
        "it has channels that are no part of a reference: {}; leave only R G B and std_error.R G B, or R G B, \
         variance.R G B and samples",
        .0.join(", ")
    )]
    Foreign(Vec<String>),
    /// Channels that are needed.
    #[error("it lacks the channels {}", .0.join(", "))]
    Missing(Vec<String>),
    /// Means without errors.
    #[error(
        "it has no errors, so nothing can be tested against it: add the standard error of each pixel's mean as \
         std_error.R G B, or the variance of a pixel's sample as variance.R G B with the channel samples"
    )]
    NoVariance,
    /// Half precision, or whole numbers.
    #[error("its channel {0} is not of 32-bit floating point, the only kind whose rounding is small enough")]
    NotFloat(String),
    /// Not a square that fits into memory.
    #[error("it has {0} x {1} pixels; a reference is a square of at most {MOST} pixels along each edge")]
    Shape(usize, usize),
    /// A value that no mean or error can have.
    #[error(
        "its pixel in column {x}, row {y} (from 0 at the top left) has {channel} = {value}; expected {expected}"
    )]
    Pixel {
        /// Column.
        x: usize,
        /// Row from the top.
        y: usize,
        /// Name of the channel.
        channel: String,
        /// What it holds there.
        value: f64,
        /// What it may hold.
        expected: &'static str,
    },
    /// A resolution for which there are no tiles.
    #[error(
        "it has {size} x {size} pixels, which {tiles} x {tiles} tiles do not divide; \
         the scene's image has {image} x {image} pixels"
    )]
    Tiles {
        /// Pixels along each edge of the reference.
        size: usize,
        /// Tiles along each edge.
        tiles: usize,
        /// Pixels along each edge of the image that is to be compared.
        image: usize,
    },
    /// A picture of another size than the scene's.
    #[error("it has {} x {} pixels; the scene's image has {} x {}", .has.0, .has.1, .scene.0, .scene.1)]
    Size {
        /// Pixels from left to right and from top to bottom.
        has: (usize, usize),
        /// Those of the scene's image.
        scene: (usize, usize),
    },
    /// One of our own whose origin cannot be understood.
    #[error("what it says of its origin is of no use: {0}")]
    Provenance(String),
}

/// More pixels than this along an edge are not read.
const MOST: usize = 4096;

/// Name of the attribute that holds the text.
const ATTRIBUTE: &str = "furnace";

/// Channels that any file of a known kind has, at most: 19 of a reference of our own.
const CHANNELS: usize = 64;

/// Bytes that one byte of a file may stand for: a little more than deflate, the tightest of the usual packings, can do.
const PACKED: usize = 1100;

/// A small image may be packed tighter still.
const SMALL: usize = 1 << 24;

/// Refuses a header that promises more than a file of so many bytes can hold.
fn plausible(header: &Header, bytes: usize) -> Result<(), BadReference> {
    let unreadable = |why: String| Err(BadReference::Unreadable(why));
    let channels = &header.channels.list;
    if header.deep {
        return unreadable("its pixels are deep".to_owned());
    }
    if channels.len() > CHANNELS {
        return unreadable(format!("it has {} channels, and at most {CHANNELS} are read", channels.len()));
    }
    let pixel: usize = channels.iter().map(|channel| channel.sample_type.bytes_per_sample()).sum();
    let promised = header.layer_size.area() * pixel;
    if promised > bytes.saturating_mul(PACKED).max(SMALL) {
        return unreadable(format!(
            "its header promises {promised} bytes of pixels, and it has {bytes} in all"
        ));
    }
    Ok(())
}

/// One picture of named channels.
#[derive(Default)]
pub struct Layers {
    /// Pixels from left to right.
    pub width: usize,
    /// Pixels from top to bottom.
    pub height: usize,
    /// Where it comes from, if it says so.
    pub provenance: Option<String>,
    channels: Vec<(String, FlatSamples)>,
}

/// `R G B` behind a prefix.
pub fn rgb_names(prefix: &str) -> [String; 3] {
    ["R", "G", "B"].map(|letter| format!("{prefix}{letter}"))
}

impl Layers {
    /// A picture without channels.
    pub fn new(width: usize, height: usize) -> Self {
        Layers { width, height, ..Layers::default() }
    }

    /// Adds a channel in single precision.
    pub fn add(&mut self, name: &str, values: Vec<f32>) {
        self.channels.push((name.to_owned(), FlatSamples::F32(values)));
    }

    /// Adds three channels in single precision.
    pub fn add_rgb(&mut self, prefix: &str, values: &[Rgb]) {
        for (c, name) in rgb_names(prefix).iter().enumerate() {
            self.add(name, values.iter().map(|v| v[c] as f32).collect());
        }
    }

    /// Adds three channels bit by bit: EXR knows no double precision, but unsigned words of 32 bits.
    pub fn add_exact(&mut self, prefix: &str, values: &[Rgb]) {
        for (c, name) in rgb_names(prefix).iter().enumerate() {
            let word = |shift: u32| values.iter().map(|v| (v[c].to_bits() >> shift) as u32).collect();
            self.channels.push((format!("{name}.high"), FlatSamples::U32(word(32))));
            self.channels.push((format!("{name}.low"), FlatSamples::U32(word(0))));
        }
    }

    /// The file; the same bytes each time.
    pub fn bytes(self) -> Result<Vec<u8>, exr::error::Error> {
        let channels = self.channels.into_iter().map(|(name, samples)| AnyChannel::new(&*name, samples));
        let channels = AnyChannels::sort(channels.collect::<SmallVec<[_; 4]>>());
        let mut attributes = LayerAttributes::default();
        if let Some(text) = self.provenance {
            // a second one would come in the changing order of a hash map
            attributes.other.insert(Text::from(ATTRIBUTE), AttributeValue::Text(Text::from(&*text)));
        }
        // the default encoding writes tiles in the order its threads finish: other bytes at each run
        let layer = Layer::new((self.width, self.height), attributes, Encoding::SMALL_LOSSLESS, channels);
        let mut file = Cursor::new(Vec::new());
        Image::from_layer(layer).write().non_parallel().to_buffered(&mut file)?;
        Ok(file.into_inner())
    }

    /// Reads a file that holds one square picture.
    pub fn read(bytes: &[u8]) -> Result<Self, BadReference> {
        let is_square = |has: (usize, usize)| has.0 == has.1 && has.0 <= MOST;
        Self::read_if(
            bytes,
            |has| if is_square(has) { Ok(()) } else { Err(BadReference::Shape(has.0, has.1)) },
        )
    }

    /// Reads a file that holds one picture of as many pixels as the image of a scene.
    pub fn read_sized(bytes: &[u8], scene: (usize, usize)) -> Result<Self, BadReference> {
        Self::read_if(bytes, |has| if has == scene { Ok(()) } else { Err(BadReference::Size { has, scene }) })
    }

    fn read_if(
        bytes: &[u8],
        check: impl Fn((usize, usize)) -> Result<(), BadReference>,
    ) -> Result<Self, BadReference> {
        let unreadable = |e: exr::error::Error| BadReference::Unreadable(e.to_string());
        // what the header promises is allocated before it is looked for
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), false).map_err(unreadable)?;
        if meta.headers.len() != 1 {
            return Err(BadReference::Pictures(meta.headers.len()));
        }
        for header in &meta.headers {
            check((header.layer_size.width(), header.layer_size.height()))?;
            plausible(header, bytes.len())?;
        }
        let reader = read().no_deep_data().largest_resolution_level().all_channels().all_layers();
        let image = reader.all_attributes().from_buffered(Cursor::new(bytes)).map_err(unreadable)?;
        let pictures = image.layer_data.len();
        let layer = image.layer_data.into_iter().next().ok_or(BadReference::Pictures(pictures))?;
        let provenance = match layer.attributes.other.get(&Text::from(ATTRIBUTE)) {
            Some(AttributeValue::Text(text)) => Some(text.to_string()),
            _ => None,
        };
        let (width, height) = (layer.size.width(), layer.size.height());
        let channels = layer.channel_data.list.into_iter();
        let channels = channels.map(|c| (c.name.to_string(), c.sample_data)).collect();
        Ok(Layers { width, height, provenance, channels })
    }

    /// Refuses channels of other names.
    pub fn only(&self, known: &[String]) -> Result<(), BadReference> {
        let names = self.channels.iter().map(|(name, _)| name);
        let foreign: Vec<String> = names.filter(|name| !known.contains(name)).cloned().collect();
        if foreign.is_empty() { Ok(()) } else { Err(BadReference::Foreign(foreign)) }
    }

    /// Whether any of these channels is there.
    pub fn any(&self, names: &[String]) -> bool {
        self.channels.iter().any(|(name, _)| names.contains(name))
    }

    /// Refuses a file without all of these channels.
    pub fn all(&self, names: &[String]) -> Result<(), BadReference> {
        let missing: Vec<String> = names.iter().filter(|name| self.find(name).is_none()).cloned().collect();
        if missing.is_empty() { Ok(()) } else { Err(BadReference::Missing(missing)) }
    }

    /// A channel in single precision, whatever its values.
    pub fn channel(&self, name: &str) -> Result<&[f32], BadReference> {
        match self.find(name) {
            None => Err(BadReference::Missing(vec![name.to_owned()])),
            Some(FlatSamples::F32(values)) => Ok(values),
            Some(_) => Err(BadReference::NotFloat(name.to_owned())),
        }
    }

    /// A channel whose values all hold what is `expected`.
    pub fn checked(
        &self,
        name: &str,
        expected: &'static str,
        holds: impl Fn(f64) -> bool,
    ) -> Result<Vec<f64>, BadReference> {
        let values: Vec<f64> = self.channel(name)?.iter().map(|&v| f64::from(v)).collect();
        match values.iter().position(|&v| !holds(v)) {
            None => Ok(values),
            Some(i) => {
                let (x, y, channel) = (i % self.width, i / self.width, name.to_owned());
                Err(BadReference::Pixel { x, y, channel, value: values[i], expected })
            }
        }
    }

    /// Three channels of finite values that are not negative.
    pub fn rgb(&self, prefix: &str) -> Result<Vec<Rgb>, BadReference> {
        self.all(&rgb_names(prefix))?;
        let [r, g, b] = rgb_names(prefix)
            .map(|name| self.checked(&name, "a finite number, not below 0", |v| v.is_finite() && v >= 0.0));
        Ok(r?.into_iter().zip(g?).zip(b?).map(|((r, g), b)| Rgb::new(r, g, b)).collect())
    }

    /// What [`Layers::add_exact`] added.
    pub fn exact(&self, prefix: &str) -> Result<Vec<Rgb>, BadReference> {
        let words = |name: String| match self.find(&name) {
            Some(FlatSamples::U32(words)) => Ok(words),
            _ => Err(BadReference::Missing(vec![name])),
        };
        let mut values = vec![Rgb::ZERO; self.width * self.height];
        for (c, name) in rgb_names(prefix).iter().enumerate() {
            let (high, low) = (words(format!("{name}.high"))?, words(format!("{name}.low"))?);
            for (value, (&high, &low)) in values.iter_mut().zip(high.iter().zip(low)) {
                value[c] = f64::from_bits(u64::from(high) << 32 | u64::from(low));
            }
        }
        Ok(values)
    }

    fn find(&self, name: &str) -> Option<&FlatSamples> {
        self.channels.iter().find(|(n, _)| n == name).map(|(_, samples)| samples)
    }
}
