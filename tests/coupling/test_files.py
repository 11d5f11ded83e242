"""Files that are written as a whole or not at all."""

from pathlib import Path

import pytest

from coupling.files import check_folder, check_free, whole_file


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


def test_a_folder_is_checked_by_writing_to_it(tmp_path):
    check_folder(tmp_path / "new" / "newer")
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "file").write_text("")
    with pytest.raises(ValueError, match=r"must be a folder; got .*file.new, but .*file is a file"):
        check_folder(tmp_path / "file" / "new")


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="needs a folder that refuses every user")
def test_a_folder_that_only_seems_writable_is_refused():
    with pytest.raises(ValueError, match="that can be written to; got /proc/new, but /proc does not allow it"):
        check_folder(Path("/proc/new"))


def test_results_are_replaced_only_on_request_and_folders_never(tmp_path):
    one, other, folder = (tmp_path / name for name in ("a.toml", "a.png", "b.toml"))
    check_free([one, other], False)
    one.write_text("")
    check_free([one, other], True)
    with pytest.raises(ValueError, match="output must be free .*, which has a.toml: --overwrite replaces it"):
        check_free([one, other], False)
    other.write_text("")
    with pytest.raises(ValueError, match="which has a.toml and a.png: --overwrite replaces them"):
        check_free([one, other], False)
    folder.mkdir()
    with pytest.raises(ValueError, match="free for b.toml; got .*, where that is a folder"):
        check_free([folder], True)
    with pytest.raises(ValueError, match="must be a folder; got .*a.toml is a file"):
        check_free([one / "c.toml"], True)
