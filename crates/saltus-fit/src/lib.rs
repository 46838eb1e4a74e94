//! saltus-fit
