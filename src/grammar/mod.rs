//! Graph grammar rules: parse, check, match, rewrite.
