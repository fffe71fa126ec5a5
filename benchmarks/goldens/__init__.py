"""Goldens prove that a refactor changed nothing: hashes of what the code made before, compared with what it makes now.

`python -m benchmarks.goldens make` writes them to `out/goldens.json`, `check` makes everything again and names what
differs. `--sample` takes a part of every subject, in under three minutes, and the committed file `sample.json`; all
take under an hour. A change on purpose is a commit that says which goldens changed and why, with a new `sample.json`.

A golden is a hash of a value: of the bytes of files and arrays, or of JSON. To look at a difference, let `make` keep
the values (`--keep FOLDER`) and `check --show FOLDER` say where they first differ.

Numbers are compared to their last bit, and these differ between processors and versions of packages. A golden file
therefore holds the versions and a hash of what this processor computes. On another platform `check` compares nothing
unless `--portable` asks for what is the same everywhere: parses, names, kinds of joints, help, exit statuses, schemas.

What is tolerated: numbers and messages of findings that rest on PyBullet, whose solver keeps what an earlier
step or process left behind; check, severity, cause and place of these findings are exact.
"""
