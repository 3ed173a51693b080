//! The script language of rule actions: a subset of GML.
