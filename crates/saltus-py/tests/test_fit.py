"""Fits: the same words and numbers as the tool, from whatever holds a table."""

import json
import pickle
import subprocess
import wave
from pathlib import Path

import numpy as np
import pandas
import polars
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import saltus

ROOT = Path(__file__).parents[3]
TABLES = sorted((ROOT / "crates/saltus-fit/tests/tables").glob("*.csv"))[:40]
SQUASH = ROOT / "examples/data/squash-on-cement.csv"


@pytest.mark.parametrize("path", [SQUASH, *TABLES], ids=lambda path: path.name)
def test_the_same_report_as_the_tool(tool, path):
    said = subprocess.run([tool, "-q", "fit", path, "--format", "json"], capture_output=True, text=True)
    text = subprocess.run([tool, "-q", "fit", path], capture_output=True, text=True)
    if said.returncode != 0:
        with pytest.raises(saltus.TableError) as failed:
            saltus.fit(path)
        assert failed.value.data == json.loads(said.stdout)["error"]
        assert str(failed.value) in text.stderr
        return
    fit = saltus.fit(path)
    assert fit.data == json.loads(said.stdout)
    assert str(fit) == text.stdout.rstrip()


def test_every_way_to_give_a_table_gives_the_same_number():
    columns = {"bounce": [0, 1, 2, 3], "height_cm": [100.0, 64.0, 41.0, 26.0]}
    ways = [
        columns,
        pandas.DataFrame(columns),
        pandas.DataFrame(columns).to_records(index=False),
        polars.DataFrame(columns),
        polars.DataFrame(columns).to_arrow(),
        {name: np.array(values) for name, values in columns.items()},
    ]
    first, *others = [saltus.fit(way, sigma_height=0.005).cor for way in ways]
    assert all(cor == first for cor in others)
    values = saltus.fit([100, 64, 41, 26], "cm", sigma_height="5 mm").cor
    assert values.value == first.value and first.low < 0.8 < first.high


def test_missing_cells_are_missing():
    frame = pandas.DataFrame({"bounce": [0, 1, 2, 3], "height_m": [1.0, 0.64, None, 0.26]})
    assert saltus.fit(frame).data["trials"] == 1
    assert saltus.fit(frame).cor.value == pytest.approx(0.8, abs=0.01)


def test_a_report_is_read_back():
    fit = saltus.fit(SQUASH)
    for again in (saltus.Fit.from_json(fit.to_json()), pickle.loads(pickle.dumps(fit))):
        assert again == fit and str(again) == str(fit)
    assert fit.verdict == "doubtful" and fit.interval == (fit.cor.low, fit.cor.high)
    assert fit.findings[0].kind == "disagree" and fit.findings[0].severity == "doubt"
    assert fit.plot().startswith("<svg") and fit.plot("profile") is None
    assert "<svg" in fit._repr_html_() and "DOUBTFUL" in fit._repr_html_()
    assert fit.scene().startswith("#")


@pytest.mark.parametrize(
    ("given", "error", "says"),
    [
        (lambda: saltus.fit([1, 2, 3]), TypeError, "unit"),
        (lambda: saltus.fit(7), TypeError, "int is no table"),
        (lambda: saltus.fit([1, 2], "kg"), ValueError, "'kg' is no unit"),
        (lambda: saltus.fit([[1, 2]], "m"), ValueError, "2 dimensions"),
        (lambda: saltus.fit({"height_m": [1, 2], "bounce": [0]}), ValueError, "not one length"),
        (lambda: saltus.fit({}), ValueError, "no columns"),
        (lambda: saltus.fit("there is none.csv"), saltus.TableError, "there is none.csv"),
        (lambda: saltus.fit([1, 0.6], "m", sigma_height="5 kg"), ValueError, "5 kg"),
        (lambda: saltus.fit([1, 0.6], "m", sigma_height=-1), saltus.SaltusError, "standard error of heights"),
        (lambda: saltus.fit([1, 0.6], "m", ball="pumpkin"), ValueError, "'pumpkin' is no ball"),
        (lambda: saltus.fit([1, 0.6], "m", model="x"), ValueError, "'x' is no model"),
        (lambda: saltus.fit([1, 0.6], "m", gravity=[9.81]), TypeError, "gravity"),
        (lambda: saltus.Fit.from_json("{}"), ValueError, "no report"),
        (lambda: saltus.fit(SQUASH).plot("x"), ValueError, "'x' is no picture"),
    ],
)
def test_what_makes_no_sense_is_refused_in_words(given, error, says):
    with pytest.raises(error, match=says):
        given()


@settings(max_examples=60, deadline=None)
@given(
    st.floats(0.3, 0.95),
    st.floats(0.1, 5.0),
    st.integers(3, 8),
)
def test_a_planted_cor_is_found(cor, height, bounces):
    heights = [height * cor ** (2 * n) for n in range(bounces + 1)]
    fit = saltus.fit(heights, "m", sigma_height=0.001 * heights[-1], drag=0, sigma_zero=0)
    assert fit.cor.value == pytest.approx(cor, abs=1e-6)


@settings(max_examples=100, deadline=None)
@given(
    st.dictionaries(
        st.text(max_size=12), st.lists(st.one_of(st.none(), st.floats(), st.text(max_size=5)), min_size=3, max_size=3)
    )
)
def test_any_table_gives_a_report_or_says_why(columns):
    try:
        saltus.fit(columns)
    except (saltus.SaltusError, ValueError) as error:
        assert str(error)


def clicks(rate=44_100, cor=0.8):
    """Seven clicks of 2 ms, each interval ``cor`` of the one before."""
    samples, time, flight = np.zeros(3 * rate), 0.2, 0.4
    for _ in range(7):
        at = int(rate * time)
        samples[at : at + 88] = 0.5 * np.sign(np.sin(np.arange(88)))
        time, flight = time + flight, cor * flight
    return samples


def test_samples_of_a_sound():
    fit = saltus.fit(clicks(), rate=44_100)
    assert abs(fit.cor.value - 0.8) < 0.001
    assert ">Sound<" in fit.plot()
    stereo = saltus.fit(np.stack([clicks(), 0 * clicks()], axis=1), rate=44_100)
    assert abs(stereo.cor.value - fit.cor.value) < 1e-6
    with pytest.raises(saltus.TableError, match="no ball is heard"):
        saltus.fit(np.zeros(44_100), rate=44_100)
    with pytest.raises(ValueError, match="rate"):
        saltus.fit(clicks(), rate=-1)
    with pytest.raises(ValueError, match="part of the samples"):
        saltus.fit(clicks(), rate=44_100, listen=(0, 1))
    with pytest.raises(TypeError, match="shape"):
        saltus.fit(np.zeros((2, 2, 2)), rate=44_100)


def test_a_recording_in_a_file(tmp_path):
    path = tmp_path / "clicks.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(44_100)
        file.writeframes((32_767 * clicks()).astype("<i2").tobytes())
    whole = saltus.fit(path)
    assert abs(whole.cor.value - 0.8) < 0.001
    later = saltus.fit(path, listen=(0.5, 3))
    assert abs(later.cor.value - 0.8) < 0.002
    with pytest.raises(ValueError, match="part of a sound"):
        saltus.fit(path, listen=(2, 1))
