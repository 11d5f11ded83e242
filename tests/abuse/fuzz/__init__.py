"""A fuzzer: mutated and generated inputs of every kind; none may end in a traceback, a hang or too much memory."""
