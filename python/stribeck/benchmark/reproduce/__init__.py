"""The papers that the catalog comes from, repeated: their tables and figures beside ours."""
