//! Random damage to texts, the same in every run.

/// A small generator of random numbers (xorshift64*), so that a failure can be repeated.
pub struct Dice(pub u64);

impl Dice {
    /// A number below a bound.
    pub fn roll(&mut self, below: usize) -> usize {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) as usize % below.max(1)
    }
}

/// One piece of damage to a text: cut, doubled, changed, or one of the words put in.
pub fn damage(text: &mut Vec<u8>, words: &[&str], dice: &mut Dice) {
    let at = dice.roll(text.len() + 1);
    let lines: Vec<&[u8]> = text.split(|&byte| byte == b'\n').collect();
    let (i, j) = (dice.roll(lines.len()), dice.roll(lines.len()));
    match dice.roll(8) {
        0 => text.truncate(at),
        1 => drop(text.drain(at..(at + dice.roll(12)).min(text.len()))),
        2 => text.insert(at, dice.roll(256) as u8),
        3 if at < text.len() => text[at] = dice.roll(256) as u8,
        4 => *text = [&lines[..i], &lines[lines.len().min(i + 1)..]].concat().join(&b'\n'),
        5 => *text = [&lines[..i], &[lines[j]], &lines[i..]].concat().join(&b'\n'),
        6 => drop(text.splice(at..at, words[dice.roll(words.len())].bytes())),
        _ => {
            // A whole value for another.
            if let Some(equal) = text[at.min(text.len())..].iter().position(|&byte| byte == b'=') {
                let start = at + equal + 1;
                let end = text[start..].iter().position(|&byte| byte == b'\n').map_or(text.len(), |n| start + n);
                text.splice(start..end, words[dice.roll(words.len())].bytes());
            }
        }
    }
}
