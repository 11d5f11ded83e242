"""Files that are written as a whole or not at all."""

import pytest

from coupling.files import whole_file


def test_a_file_is_there_only_when_it_is_whole(tmp_path):
    path = tmp_path / "one.txt"
    with whole_file(path) as partial:
        partial.write_text("half")
        assert not path.exists() and partial.parent == tmp_path and partial.suffix == ".txt"
    assert [file.name for file in tmp_path.iterdir()] == ["one.txt"] and path.read_text() == "half"


def test_what_fails_leaves_the_older_file(tmp_path):
    path = tmp_path / "one.txt"
    path.write_text("older")
    with pytest.raises(KeyboardInterrupt), whole_file(path) as partial:
        partial.write_text("half")
        raise KeyboardInterrupt
    assert [file.name for file in tmp_path.iterdir()] == ["one.txt"] and path.read_text() == "older"
