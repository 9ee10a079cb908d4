"""Effects added to a model one at a time: screened, fitted, tested and ranked."""
