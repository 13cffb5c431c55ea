//! The palette of Okabe and Ito, which readers with any colour vision can tell apart.

/// A colour of the palette, or the neutral grey for references.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Colour {
    /// #0072B2
    Blue,
    /// #E69F00
    Orange,
    /// #009E73
    Green,
    /// #D55E00
    Vermilion,
    /// #CC79A7
    Purple,
    /// #56B4E9
    Sky,
    /// #000000
    Black,
    /// #F0E442: too pale for thin lines on white.
    Yellow,
    /// #707070: not of the palette, for margins and other references.
    Grey,
}

impl Colour {
    /// The colour for the series with this index; starts again after seven. Yellow and grey are not
    /// given out.
    pub fn nth(index: usize) -> Self {
        const ALL: [Colour; 7] = [
            Colour::Blue,
            Colour::Orange,
            Colour::Green,
            Colour::Vermilion,
            Colour::Purple,
            Colour::Sky,
            Colour::Black,
        ];
        ALL[index % ALL.len()]
    }

    /// Red, green and blue, each 0..=255 in sRGB.
    pub fn rgb(self) -> (u8, u8, u8) {
        match self {
            Self::Blue => (0x00, 0x72, 0xB2),
            Self::Orange => (0xE6, 0x9F, 0x00),
            Self::Green => (0x00, 0x9E, 0x73),
            Self::Vermilion => (0xD5, 0x5E, 0x00),
            Self::Purple => (0xCC, 0x79, 0xA7),
            Self::Sky => (0x56, 0xB4, 0xE9),
            Self::Black => (0x00, 0x00, 0x00),
            Self::Yellow => (0xF0, 0xE4, 0x42),
            Self::Grey => (0x70, 0x70, 0x70),
        }
    }

    /// Whether areas of this colour are hatched upwards and downwards, so that neighbours in the
    /// palette differ without colour.
    pub(super) fn hatch(self) -> (bool, bool) {
        match self {
            Self::Blue | Self::Purple => (false, false),
            Self::Orange | Self::Sky | Self::Grey => (true, false),
            Self::Green | Self::Black => (false, true),
            Self::Vermilion | Self::Yellow => (true, true),
        }
    }
}
