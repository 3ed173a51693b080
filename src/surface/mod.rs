//! A frozen limit surface: line hit, closest point, deviation.
