"""The nightly regression run: benchmark and validation, compared with earlier nights, as files and pages."""
