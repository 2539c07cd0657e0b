import pytest

from safe.companion.exercise import check


def unwritten():
    raise NotImplementedError


@pytest.mark.parametrize(
    ("task", "said"), [(unwritten, "Not yet. A function is still to be written.\n"), (lambda: 4, "Right.\n")]
)
def test_a_check_says_how_it_went(capsys, task, said):
    @check
    def check_task():
        assert task() == 4

    check_task()
    assert capsys.readouterr().out == said


def test_what_is_wrong_is_an_error_with_the_checks_own_message(capsys):
    @check
    def check_task():
        assert 3 + 3 == 4, "the task should give 4, and gives 6"

    with pytest.raises(AssertionError, match="the task should give 4, and gives 6"):
        check_task()
    assert capsys.readouterr().out == ""
