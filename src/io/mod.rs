//! OBJ and PLY in and out, with an import report.
