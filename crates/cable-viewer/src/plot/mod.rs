//! Plots against time (egui_plot) with decimation and export.
