//! How texts are set: names of keys and files in code letters, minus signs, powers of ten, units and symbols as in
//! print.

use super::markup::escape;

/// Symbols as programs write them: letter and index.
const SYMBOLS: [(&str, &str, &str); 12] = [
    ("ε_α", "ε", "α"),
    ("ε_β", "ε", "β"),
    ("eps_alpha", "ε", "α"),
    ("eps_beta", "ε", "β"),
    ("c_γ", "c", "γ"),
    ("K_Hbeta", "K", "Hβ"),
    ("K_Halpha", "K", "Hα"),
    ("c_gamma", "c", "γ"),
    ("theta_1", "θ", "1"),
    ("theta_2", "θ", "2"),
    ("r_b1", "r", "b1"),
    ("r_b2", "r", "b2"),
];

/// The pressure after Hertz; short enough to be part of other words.
const PRESSURE: (&str, &str, &str) = ("p_H", "p", "H");

/// Units in letters, behind a space or a bracket.
const UNITS: [(&str, &str); 4] = [
    ("N m", "N·m"),
    ("N/(mm um)", "N/(mm·µm)"),
    ("um", "µm"),
    ("urad", "µrad"),
];

/// As HTML: escaped, names in back-ticks as code, indices below the line.
pub(super) fn html(text: &str) -> String {
    let code = |name: &str| format!("<code>{}</code>", escape(name));
    set(text, escape, code, |letter, index| {
        format!("{letter}<sub>{index}</sub>")
    })
}

/// As the text of an SVG, which knows neither tag.
pub(super) fn svg(text: &str) -> String {
    set(text, escape, escape, |letter, index| {
        format!(
            "{letter}<tspan dy=\"3\" font-size=\"85%\">{index}</tspan><tspan dy=\"-3\">\u{200b}</tspan>"
        )
    })
}

/// Without any markup, for attributes and for what a script draws; not escaped.
pub(super) fn plain(text: &str) -> String {
    // Digits have a lowered form, letters have none.
    set(
        text,
        str::to_owned,
        str::to_owned,
        |letter, index| match index {
            "1" => format!("{letter}₁"),
            "2" => format!("{letter}₂"),
            _ => format!("{letter}_{index}"),
        },
    )
}

fn set(
    text: &str,
    letters: fn(&str) -> String,
    code: impl Fn(&str) -> String,
    index: impl Fn(&str, &str) -> String,
) -> String {
    let parts = parts(text).map(|(part, is_code)| match is_code {
        true => code(part),
        false => symbols(&letters(&numbers_and_units(part)), &index),
    });
    parts.collect()
}

/// What stands between back-ticks, and what does not; a back-tick without a second one is an apostrophe's.
fn parts(text: &str) -> impl Iterator<Item = (&str, bool)> {
    let pairs = text.matches('`').count() / 2;
    let parts = text.split('`').enumerate();
    parts
        .map(move |(k, part)| (part, k % 2 == 1 && k < 2 * pairs))
        .filter(|(part, _)| !part.is_empty())
}

fn is_part_of_word(c: Option<char>) -> bool {
    c.is_some_and(|c| c.is_alphanumeric() || c == '_')
}

/// Replaces `from` where it is a word of its own.
fn replaced(text: &str, from: &str, to: &str) -> String {
    let mut set = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find(from) {
        let (before, behind) = (&rest[..at], &rest[at + from.len()..]);
        let last = before.chars().next_back().or(set.chars().next_back());
        set.push_str(before);
        let is_word = !is_part_of_word(last) && !is_part_of_word(behind.chars().next());
        set.push_str(if is_word { to } else { from });
        rest = behind;
    }
    set + rest
}

fn symbols(text: &str, index: impl Fn(&str, &str) -> String) -> String {
    let all = SYMBOLS.iter().chain([&PRESSURE]);
    all.fold(text.to_owned(), |text, (from, letter, below)| {
        match text.contains(from) {
            true => replaced(&text, from, &index(letter, below)),
            false => text,
        }
    })
}

fn numbers_and_units(text: &str) -> String {
    let text = UNITS.iter().fold(text.to_owned(), |text, (from, to)| {
        match text.contains(from) {
            true => replaced(&text, from, to),
            false => text,
        }
    });
    let letters: Vec<char> = text.chars().collect();
    let mut set = String::with_capacity(text.len());
    let mut at = 0;
    while at < letters.len() {
        let before = at.checked_sub(1).map(|k| letters[k]);
        let is_first = !before.is_some_and(|c| c.is_alphanumeric() || "_.-−+".contains(c));
        match number(&letters[at..]).filter(|_| is_first) {
            Some((length, words)) => {
                set.push_str(&words);
                at += length;
            }
            None => {
                set.push(letters[at]);
                at += 1;
            }
        }
    }
    set
}

/// A number that begins here and is no part of a word: its letters, and how it is set.
fn number(letters: &[char]) -> Option<(usize, String)> {
    let digits = |from: usize| {
        letters[from..]
            .iter()
            .take_while(|c| c.is_ascii_digit())
            .count()
    };
    let sign = usize::from(letters[0] == '-');
    let whole = digits(sign);
    if whole == 0 {
        return None;
    }
    let mut end = sign + whole;
    if letters.get(end) == Some(&'.') && digits(end + 1) > 0 {
        end += 1 + digits(end + 1);
    }
    let mantissa: String = letters[sign..end].iter().collect();
    let mut words = if sign == 1 {
        "−".to_owned()
    } else {
        String::new()
    };
    let mut power = String::new();
    if letters.get(end) == Some(&'e') {
        let minus = usize::from(matches!(letters.get(end + 1), Some('-' | '+')));
        let count = digits(end + 1 + minus);
        if count > 0 {
            let first = end + 1 + minus;
            let negative = letters[end + 1] == '-';
            let exponent: String = letters[first..first + count].iter().collect();
            power = raised(&exponent, negative);
            end = first + count;
        }
    }
    let next = letters.get(end).copied();
    // A date, a version, a hash.
    let goes_on = is_part_of_word(next)
        || next == Some('.') && letters.get(end + 1).is_some_and(char::is_ascii_digit)
        || next == Some('-') && letters.get(end + 1).is_some_and(|c| c.is_alphanumeric());
    if goes_on && (sign == 0 || !power.is_empty()) {
        return None;
    }
    words += &match (&power[..], &mantissa[..]) {
        ("", _) => mantissa,
        (power, "1") => format!("10{power}"),
        (power, _) => format!("{mantissa}·10{power}"),
    };
    Some((end, words))
}

/// An exponent above the line.
fn raised(digits: &str, negative: bool) -> String {
    const FORMS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let digits = digits.trim_start_matches('0').chars();
    let digits = digits.filter_map(|c| FORMS.get(c.to_digit(10)? as usize));
    negative
        .then_some('⁻')
        .into_iter()
        .chain(digits.copied())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_set_as_in_print() {
        for (text, set) in [
            ("K_Hbeta 1.8 at 200 N m", "K<sub>Hβ</sub> 1.8 at 200 N·m"),
            (
                "mesh `first <stage>`: -3 um",
                "mesh <code>first &lt;stage&gt;</code>: −3 µm",
            ),
            ("4.0e-7 of 1e5, [-1.5e+07]", "4.0·10⁻⁷ of 10⁵, [−1.5·10⁷]"),
            ("`load N m = -4`", "<code>load N m = -4</code>"),
            ("TE = r_b2 theta_2", "TE = r<sub>b2</sub> θ<sub>2</sub>"),
            ("don`t", "dont"),
            ("p_H MPa, drop_H", "p<sub>H</sub> MPa, drop_H"),
        ] {
            assert_eq!(html(text), set);
        }
        assert_eq!(plain("`mesh` K_Hbeta theta_1"), "mesh K_Hβ θ₁");
        assert!(svg("K_Hbeta < 2").starts_with("K<tspan") && svg("K_Hbeta < 2").contains("&lt; 2"));
    }

    #[test]
    fn dates_hashes_versions_and_names_stay() {
        for text in [
            "2026-11-24T15:29:14Z",
            "0e7a9dcc544d8776c3dbe9",
            "12e4af",
            "gearmesh 0.2.0",
            "pair_23-47, ISO 6336-1, 13/35",
            "drum, N mesh, sum",
        ] {
            assert_eq!(html(text), text);
        }
    }
}
