//! Sound files made unsound: the mutations that fuzzers make of a corpus, without feedback from coverage.

use fastrand::Rng;

/// Numbers at which programs stumble.
const NUMBERS: [&str; 26] = [
    "0",
    "-0.0",
    "1",
    "-1",
    "2",
    "3",
    "1e-300",
    "1e-30",
    "-1e-30",
    "1e-9",
    "0.5",
    "0.999999999",
    "1.000000001",
    "90",
    "180",
    "1000",
    "1e6",
    "1e9",
    "-1e9",
    "1e12",
    "1e18",
    "1e30",
    "1e300",
    "4294967296",
    "9223372036854775807",
    "nan",
];

/// Words and signs at which parsers stumble.
const WORDS: [&str; 20] = [
    "",
    "=",
    "[",
    "]",
    "[[",
    "]]",
    "{",
    "}",
    ",",
    "\"",
    "'''",
    "#",
    "\n",
    "\r\n",
    "\u{feff}",
    "\u{0}",
    "..",
    "/",
    "é",
    "[[body]]\n",
];

/// A text with one to four faults; other texts of the corpus lend lines and values.
pub fn text(corpus: &[String], random: &mut Rng) -> String {
    let mut text = corpus[random.usize(..corpus.len())].clone();
    for _ in 0..random.usize(1..=4) {
        text = once(text, corpus, random);
    }
    text
}

fn once(text: String, corpus: &[String], random: &mut Rng) -> String {
    match random.u8(..12) {
        // Values weigh most: syntax errors end early.
        0..=5 => with_another_value(&text, corpus, random),
        6 | 7 => with_lines_moved(&text, random),
        8 => with_a_line_of(&text, &corpus[random.usize(..corpus.len())], random),
        9 => replaced(&text, random, |random| {
            WORDS[random.usize(..WORDS.len())].to_owned()
        }),
        10 => replaced(&text, random, |_| String::new()),
        _ => replaced(&text, random, |random| {
            char::from_u32(random.u32(..0x300))
                .unwrap_or('x')
                .to_string()
                .repeat(random.usize(1..40))
        }),
    }
}

/// Spans of the numbers of a text.
fn numbers(text: &str) -> Vec<(usize, usize)> {
    let is_part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | '+' | 'e');
    let mut spans = Vec::new();
    let mut begin = None;
    let mut before = ' ';
    for (place, c) in text.char_indices().chain([(text.len(), ' ')]) {
        match begin {
            None if (c.is_ascii_digit() || c == '-')
                && !before.is_alphanumeric()
                && before != '_' =>
            {
                begin = Some(place)
            }
            Some(first) if !is_part(c) => {
                spans.push((first, place));
                begin = None;
            }
            _ => {}
        }
        before = c;
    }
    spans
}

fn with_another_value(text: &str, corpus: &[String], random: &mut Rng) -> String {
    let spans = numbers(text);
    if spans.is_empty() {
        return text.to_owned();
    }
    let (begin, end) = spans[random.usize(..spans.len())];
    let old = &text[begin..end];
    let new = match random.u8(..6) {
        0..=2 => NUMBERS[random.usize(..NUMBERS.len())].to_owned(),
        3 => old.parse::<f64>().map_or(String::new(), |value| {
            format!("{:?}", value * 10_f64.powi(random.i32(-12..=12)))
        }),
        4 => format!("-{old}"),
        _ => {
            let other = &corpus[random.usize(..corpus.len())];
            let spans = numbers(other);
            spans
                .get(random.usize(..spans.len().max(1)))
                .map_or("7", |&(a, b)| &other[a..b])
                .to_owned()
        }
    };
    format!("{}{new}{}", &text[..begin], &text[end..])
}

fn with_lines_moved(text: &str, random: &mut Rng) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    if lines.is_empty() {
        return text.to_owned();
    }
    let place = random.usize(..lines.len());
    let other = random.usize(..lines.len());
    match random.u8(..3) {
        0 => drop(lines.remove(place)),
        1 => lines.insert(place, lines[other]),
        _ => lines.swap(place, other),
    }
    lines.join("\n") + "\n"
}

fn with_a_line_of(text: &str, other: &str, random: &mut Rng) -> String {
    let mut lines: Vec<&str> = text.lines().collect();
    let others: Vec<&str> = other.lines().collect();
    if let Some(line) = others.get(random.usize(..others.len().max(1))) {
        lines.insert(random.usize(..=lines.len()), line);
    }
    lines.join("\n") + "\n"
}

/// A stretch of up to a dozen characters replaced.
fn replaced(text: &str, random: &mut Rng, by: impl Fn(&mut Rng) -> String) -> String {
    let places: Vec<usize> = text
        .char_indices()
        .map(|(place, _)| place)
        .chain([text.len()])
        .collect();
    let first = random.usize(..places.len());
    let last = (first + random.usize(..12)).min(places.len() - 1);
    format!(
        "{}{}{}",
        &text[..places[first]],
        by(random),
        &text[places[last]..]
    )
}

/// Bytes with one to four faults, after the first `from`.
pub fn bytes(sound: &[u8], from: usize, random: &mut Rng) -> Vec<u8> {
    let mut bytes = sound.to_vec();
    for _ in 0..random.usize(1..=4) {
        let place = random.usize(from..bytes.len());
        let length = (bytes.len() - place).min(8);
        match random.u8(..6) {
            0 => bytes[place] ^= 1 << random.u8(..8),
            1 => bytes[place] = random.u8(..),
            2 => bytes[place..place + length].fill(0),
            3 => bytes[place..place + length].fill(0xff),
            4 => {
                // An address or length of somewhere else in the file.
                let number = random.u64(..bytes.len() as u64).to_le_bytes();
                bytes[place..place + length].copy_from_slice(&number[..length]);
            }
            _ => {
                let other = random.usize(from..bytes.len());
                let length = length.min(bytes.len() - other);
                bytes.copy_within(other..other + length, place);
            }
        }
    }
    bytes
}
