# Start with `make demo`, then `make test`.

.PHONY: demo test setup check msrv lint bench fuzz accuracy platforms semver vscode
.DEFAULT_GOAL := demo

# Builds, checks the course's shaders and writes images and reports to out/. Of the whole workspace the program alone is
# built, with the features that tests select, so that `make test` reuses all of it.
demo: setup
	cargo build --release --workspace --bin toyproof
	./target/release/toyproof check glsl --out out

# Also counts the tests that were skipped because a driver or a program is missing.
test:
	tests/run.sh

# Type-checks all crates, tests and benchmarks without building them.
check:
	cargo check --workspace --all-targets

# Type-checks with the minimum supported version of Rust. Uses its own folder, since builds of two versions overwrite each
# other's artifacts.
msrv:
	CARGO_TARGET_DIR=$${CARGO_TARGET_DIR:-target}/msrv cargo +1.89 check --workspace --all-targets --locked

# In the profile of the tests, whose build scripts and macros it reuses.
lint:
	cargo fmt --all --check
	cargo clippy --release --workspace --all-targets -- -D warnings

# Checks the build's requirements and installs Mesa's lavapipe, on which shaders run; see `toyproof doctor`.
setup:
	@./setup.sh

bench:
	XDG_RUNTIME_DIR=$${XDG_RUNTIME_DIR:-/tmp} cargo bench

# Measures again: writes docs/evidence/accuracy/ and the generated parts of docs/evidence/accuracy.md.
accuracy:
	cargo build --release --workspace --bin toyproof
	sh docs/evidence/accuracy/regenerate.sh ./target/release/toyproof

# Runs a fuzz target until it finds something or is stopped: front_end, tokens, programs, scenes, images, records or
# projects. Needs a nightly compiler and cargo-fuzz. No sanitizer: the code is safe Rust. The time limit is one of a
# hang; the targets themselves limit the processor time of an input.
TARGET ?= front_end
fuzz:
	mkdir -p fuzz/corpus/$(TARGET)
	cargo +nightly fuzz run -s none $(TARGET) fuzz/corpus/$(TARGET) $(wildcard fuzz/seeds/$(TARGET) fuzz/regressions/$(TARGET)) glsl -- \
		$(addprefix -dict=,$(wildcard fuzz/dictionaries/$(TARGET).dict)) -max_len=4096 -timeout=600 -rss_limit_mb=3000

# Tests Windows under wine and aarch64 under qemu; type-checks for macOS and WebAssembly.
platforms:
	tests/platforms.sh

# Compares the public interfaces of the crates with those of a revision, such as the tag of the last release. Needs
# cargo-semver-checks.
BASE ?= HEAD~1
semver:
	cargo semver-checks --workspace --exclude toyproof-testkit --exclude xtask --baseline-rev $(BASE)

# Checks, tests and builds the extension for Visual Studio Code: editors/vscode/toyproof.vsix. Needs Node.js 20 or later, and
# only npm's registry. The date of the files in it is the commit's, so that building it again gives the same bytes.
vscode:
	cd editors/vscode && npm ci --ignore-scripts --no-audit --no-fund && npm run lint && npm test
	cd editors/vscode && SOURCE_DATE_EPOCH=$$(git log -1 --format=%ct) npm run package
