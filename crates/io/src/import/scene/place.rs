//! Where things stand: moves, turns, scales.
//!
//! ```text
//!   scale = s or [sx, sy, sz]  ──▶  rotate = [a, b, c] about x, y, z in turn, or a about z  ──▶  at = [x, y, z]
//!   matrix = [[xx, xy, xz, tx], [yx, yy, yz, ty], [zx, zy, zz, tz]]
//! ```

use super::text::{Outcome, Table, Value};
use crate::spline::arc::sin_cos;
use glam::{DAffine3, DMat3, DVec3};

/// The placement that a table's keys describe; `None` without any.
pub(super) fn placement(table: &mut Table<'_>) -> Outcome<Option<DAffine3>> {
    let at = table.read("at", Value::point)?;
    let rotate = table.read("rotate", |v| {
        let angles = if v.list().is_ok() { v.numbers()? } else { vec![0.0, 0.0, v.number()?] };
        angles.try_into().map(DVec3::from_array).map_err(|_| v.fault("3 angles are wanted, about x, y and z"))
    })?;
    let scale = table.read("scale", |v| {
        let scale = match v.list() {
            Err(_) => DVec3::splat(v.number()?),
            Ok(list) if list.len() == 2 => v.point()?.with_z(1.0),
            Ok(_) => v.point()?,
        };
        if scale.abs().min_element() > 0.0 { Ok(scale) } else { Err(v.fault("a scale of 0 leaves nothing")) }
    })?;
    let single = at.is_some() || rotate.is_some() || scale.is_some();
    if let Some(value) = table.get("matrix") {
        let matrix = matrix(value)?;
        return if single { Err(value.fault("beside `at`, `rotate` or `scale`")) } else { Ok(Some(matrix)) };
    }
    if !single {
        return Ok(None);
    }
    let linear = turned(rotate.unwrap_or(DVec3::ZERO)) * DMat3::from_diagonal(scale.unwrap_or(DVec3::ONE));
    Ok(Some(DAffine3::from_mat3_translation(linear, at.unwrap_or(DVec3::ZERO))))
}

/// Turned about x, then y, then z, in degrees; exact for quarter turns.
fn turned(degrees: DVec3) -> DMat3 {
    let about = |axis: usize| {
        let (s, c) = sin_cos(degrees[axis].to_radians());
        let (x, y) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
        let mut columns = [DVec3::AXES[axis]; 3];
        columns[(axis + 1) % 3] = x * c + y * s;
        columns[(axis + 2) % 3] = y * c - x * s;
        DMat3::from_cols(columns[0], columns[1], columns[2])
    };
    about(2) * about(1) * about(0)
}

/// Three rows of four numbers.
fn matrix(value: Value<'_>) -> Outcome<DAffine3> {
    let rows = value.list()?.into_iter().map(Value::numbers).collect::<Outcome<Vec<_>>>()?;
    if rows.len() != 3 || rows.iter().any(|r| r.len() != 4) {
        return Err(value.fault("3 rows of 4 numbers are wanted"));
    }
    let column = |i: usize| DVec3::new(rows[0][i], rows[1][i], rows[2][i]);
    let linear = DMat3::from_cols(column(0), column(1), column(2));
    let lengths = column(0).length() * column(1).length() * column(2).length();
    // columns in one plane, to rounding
    if linear.determinant().abs() <= 1e-12 * lengths {
        return Err(value.fault("it flattens space"));
    }
    Ok(DAffine3::from_mat3_translation(linear, column(3)))
}
