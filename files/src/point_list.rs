//! Reading lists of points: one a line, coordinates separated by commas, semicolons or blanks.

use std::fmt;

use glam::DVec2;

/// Why a text is no list of points. Lines count from 1.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum PointListError {
    /// A line with fewer fields than the columns need.
    Missing { line: usize },
    /// A field that is not a finite number.
    NotANumber { line: usize, field: String },
}

impl fmt::Display for PointListError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing { line } => write!(out, "line {line} has no two coordinates"),
            Self::NotANumber { line, field } => {
                write!(out, "line {line}: {field:?} is not a finite number")
            }
        }
    }
}

impl std::error::Error for PointListError {}

/// The points of a list. A first line with names tells which columns are `x` and `y`; otherwise they are
/// the first two. Empty lines and lines that begin with `#` are skipped.
///
/// # Errors
/// [`PointListError`] at the first line that holds no point.
pub fn parse(text: &str) -> Result<Vec<DVec2>, PointListError> {
    let mut points = Vec::new();
    let mut columns = [0, 1];
    let mut first = true;
    for (line, content) in (1..).zip(text.lines()) {
        let content = content.trim_start_matches('\u{feff}').trim();
        if content.is_empty() || content.starts_with('#') {
            continue;
        }
        let fields: Vec<&str> = fields(content);
        if std::mem::take(&mut first) && fields.iter().all(|f| f.parse::<f64>().is_err()) {
            let column = |name| fields.iter().position(|f| f.eq_ignore_ascii_case(name));
            if let (Some(x), Some(y)) = (column("x"), column("y")) {
                columns = [x, y];
            }
            continue;
        }
        let mut point = [0.0; 2];
        for (coordinate, column) in point.iter_mut().zip(columns) {
            let field = *fields.get(column).ok_or(PointListError::Missing { line })?;
            *coordinate = match field.parse::<f64>() {
                Ok(number) if number.is_finite() => number,
                _ => {
                    let field = field.chars().take(40).collect();
                    return Err(PointListError::NotANumber { line, field });
                }
            };
        }
        points.push(DVec2::from_array(point));
    }
    Ok(points)
}

/// Fields between commas or semicolons, or between blanks where there is neither.
fn fields(line: &str) -> Vec<&str> {
    if line.contains([',', ';']) {
        line.split([',', ';']).map(|field| field.trim().trim_matches('"')).collect()
    } else {
        line.split_whitespace().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn columns_are_named_or_the_first_two() {
        let expected = vec![DVec2::new(1.0, 2.5), DVec2::new(-3e-4, 0.0)];
        for text in [
            "x,y\n1,2.5\n-3e-4,0\n",
            "1 2.5\n-0.0003\t0",
            "# a comment\n\n1;2.5;9\r\n-3e-4;0;9",
            "\u{feff}\"Rank\",\"Y\",\"X\"\n7,2.5,1\n8,0,-3e-4",
        ] {
            assert_eq!(parse(text).as_ref(), Ok(&expected), "{text}");
        }
        assert_eq!(parse(""), Ok(vec![]));
        assert_eq!(parse("x,y\n"), Ok(vec![]));
    }

    #[test]
    fn mistakes_are_located() {
        assert_eq!(parse("x,y\n1,2\n3"), Err(PointListError::Missing { line: 3 }));
        let not = |line, field: &str| Err(PointListError::NotANumber { line, field: field.into() });
        assert_eq!(parse("1,2\n\n3,nan"), not(3, "nan"));
        assert_eq!(parse("1,inf"), not(1, "inf"));
        assert_eq!(parse("x,y\nx,y"), not(2, "x"));
        assert_eq!(parse("1,"), not(1, ""));
    }

    proptest! {
        #[test]
        fn any_text_is_a_list_or_an_error(text in "[x,y0-9. ;#e\\-\n\"]{0,200}") {
            if let Ok(points) = parse(&text) {
                prop_assert!(points.iter().all(|p| p.is_finite()));
            }
        }
    }
}
