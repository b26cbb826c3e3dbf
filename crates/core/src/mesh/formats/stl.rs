//! Triangles from STL files, ASCII and binary. Normals in the file are passed over: the order of the corners says where
//! outward is.

use crate::tensor::Vec3;

const HEADER: usize = 84;
const RECORD: usize = 50;

/// Reads the corners of the triangles from a file's bytes.
///
/// # Errors
/// In words, with the line or the triangle concerned.
pub fn read(bytes: &[u8]) -> Result<Vec<[Vec3; 3]>, String> {
    let count = bytes.get(80..HEADER).map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]) as usize);
    // A binary file may begin with "solid" as well: its length tells.
    let exact = count.is_some_and(|n| n.checked_mul(RECORD).and_then(|n| n.checked_add(HEADER)) == Some(bytes.len()));
    let is_text = bytes.trim_ascii_start().starts_with(b"solid") && !exact;
    let triangles = if is_text { text(bytes)? } else { binary(bytes, count)? };
    if triangles.is_empty() { Err("it holds no triangle".into()) } else { Ok(triangles) }
}

fn binary(bytes: &[u8], count: Option<usize>) -> Result<Vec<[Vec3; 3]>, String> {
    let count = count.ok_or("it is too short for an STL file")?;
    let records = &bytes[HEADER..];
    if records.len() / RECORD < count {
        return Err(format!("it announces {count} triangles and ends after {}", records.len() / RECORD));
    }
    records.chunks_exact(RECORD).take(count).enumerate().map(|(i, record)| triangle(i, record)).collect()
}

fn triangle(i: usize, record: &[u8]) -> Result<[Vec3; 3], String> {
    let number = |k: usize| f64::from(f32::from_le_bytes([record[k], record[k + 1], record[k + 2], record[k + 3]]));
    let corner = |c: usize| Vec3(std::array::from_fn(|k| number(12 + 12 * c + 4 * k)));
    let corners = [corner(0), corner(1), corner(2)];
    if corners.iter().all(|corner| corner.is_finite()) {
        return Ok(corners);
    }
    Err(format!("triangle {} has a coordinate that is not a finite number", i + 1))
}

fn text(bytes: &[u8]) -> Result<Vec<[Vec3; 3]>, String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "it begins as text and goes on otherwise".to_owned())?;
    let (mut triangles, mut corners) = (Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate().map(|(i, line)| (i + 1, line)) {
        let mut words = line.split_ascii_whitespace();
        match words.next() {
            Some("vertex") => corners.push(vertex(words, number)?),
            Some("endfacet") => {
                let [a, b, c] = corners[..] else {
                    return Err(format!("line {number}: a facet has {} corners, not three", corners.len()));
                };
                triangles.push([a, b, c]);
                corners.clear();
            }
            Some("solid" | "facet" | "outer" | "endloop" | "endsolid") | None => {}
            Some(other) => return Err(format!("line {number}: `{other}` is no word of an STL file")),
        }
    }
    if corners.is_empty() { Ok(triangles) } else { Err("it ends within a facet".into()) }
}

fn vertex<'t>(words: impl Iterator<Item = &'t str>, line: usize) -> Result<Vec3, String> {
    let bad = || format!("line {line}: a vertex has three finite numbers");
    let numbers: Vec<f64> = words.map(str::parse).collect::<Result<_, _>>().map_err(|_| bad())?;
    match numbers[..] {
        [x, y, z] if Vec3([x, y, z]).is_finite() => Ok(Vec3([x, y, z])),
        _ => Err(bad()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid tip
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1.5e0 0
endloop
endfacet
facet normal 0 0 0
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 2 0 0
endloop
endfacet
endsolid tip
";

    fn binary(triangles: &[[f32; 9]], head: &[u8]) -> Vec<u8> {
        let mut bytes = head.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for triangle in triangles {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn both_kinds_give_the_same_triangles() {
        let text = read(TEXT.as_bytes()).unwrap();
        assert_eq!((text.len(), text[0][2]), (2, Vec3::new(0.0, 1.5, 0.0)));
        let flat = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0, 0.0, 0.0];
        let bytes = binary(&[[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.5, 0.0], flat], b"solid by a program that says so");
        assert_eq!(read(&bytes).unwrap(), text);
    }

    #[test]
    fn faults_are_told() {
        let fault = |text: &str| read(text.as_bytes()).unwrap_err();
        assert_eq!(fault("solid a\nendsolid a\n"), "it holds no triangle");
        assert_eq!(fault("not an STL"), "it is too short for an STL file");
        assert_eq!(fault(&TEXT.replace("1.5e0", "one")), "line 6: a vertex has three finite numbers");
        assert_eq!(fault(&TEXT.replace("1.5e0", "inf")), "line 6: a vertex has three finite numbers");
        assert_eq!(fault(&TEXT.replace("outer loop", "outher loop")), "line 3: `outher` is no word of an STL file");
        assert_eq!(fault(&TEXT.replacen("vertex 0 0 0\n", "", 1)), "line 7: a facet has 2 corners, not three");
        let whole = binary(&[[1.0; 9], [2.0; 9]], b"binary");
        assert_eq!(read(&whole[..150]).unwrap_err(), "it announces 2 triangles and ends after 1");
        let wild = binary(&[[f32::NAN; 9]], b"binary");
        assert_eq!(read(&wild).unwrap_err(), "triangle 1 has a coordinate that is not a finite number");
    }
}
