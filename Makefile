# What a newcomer types: `make demo`, then `make test`.

.PHONY: demo test setup bench
.DEFAULT_GOAL := demo

# Builds, checks the course's shaders and says where the pictures are.
demo: setup
	cargo build --release
	./target/release/toyproof check glsl --out out

test:
	cargo test

# Mesa's lavapipe, on which the shaders run; see `toyproof doctor`.
setup:
	@./setup.sh

bench:
	XDG_RUNTIME_DIR=$${XDG_RUNTIME_DIR:-/tmp} cargo bench
