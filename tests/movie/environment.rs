//! The environment: the encoder of H.264 reads more than a hundred variables where it is built with `std`, and here none of them changes a movie.

use crate::frames::{disc, noise, rate, write};
use dragonfly_kit::folder::{Folder, takes_long};
use dragonfly_kit::random::Random;
use dragonfly_movie::{MovieSettings, MovieTarget};
use std::path::Path;
use std::process::Command;

const TEST: &str = "environment::no_variable_of_the_environment_changes_the_bytes_of_a_movie";

/// Variable with the path of the movie that a child process writes.
const MOVIE: &str = "DRAGONFLY_MOVIE_OF_A_CHILD";

/// Every variable that version 0.17.0 of the encoder, and the crates that it brings, read.
const VARIABLES: &[&str] = &[
    "RFF_ABL_DEBLOCK",
    "RFF_ABL_INTRA",
    "RFF_ABL_MC",
    "RFF_ABL_RECON",
    "RFF_AQ_GRAIN",
    "RFF_BDIRECT_PLANES",
    "RFF_BITACCT",
    "RFF_BSKIP_BUSY",
    "RFF_BSKIP_DIRWIN",
    "RFF_BSKIP_T",
    "RFF_BSPLIT",
    "RFF_BSTATS",
    "RFF_CENSUS_CSV",
    "RFF_DEFER_SUBPEL",
    "RFF_DIA_LADDER",
    "RFF_DIA_SUB",
    "RFF_GATE_CENSUS",
    "RFF_GRAIN_FLOORMIN",
    "RFF_GRAIN_MGAINMAX",
    "RFF_GRAIN_SUBPEL",
    "RFF_GRAIN_VARMAX",
    "RFF_HPEL_AVX2",
    "RFF_HPEL_FUSED",
    "RFF_HPEL_PAD",
    "RFF_HPEL_REF",
    "RFF_I8_IN_P",
    "RFF_I8_MARGIN",
    "RFF_INTER8",
    "RFF_INTER8_PEN",
    "RFF_INTRA_RD",
    "RFF_INTRA_RD_ALL",
    "RFF_LME_Q",
    "RFF_MBTREE_DBG",
    "RFF_MBTREE_GOPSTATS",
    "RFF_MBTREE_GRAIN",
    "RFF_MBTREE_LA",
    "RFF_MBTREE_RESMIN",
    "RFF_MBTREE_SDMIN",
    "RFF_MECTX",
    "RFF_ME_BATCH",
    "RFF_ME_COH",
    "RFF_ME_COH_DBG",
    "RFF_ME_FASTMO",
    "RFF_ME_FC",
    "RFF_ME_HR",
    "RFF_ME_HR_DBG",
    "RFF_ME_LEARN",
    "RFF_ME_ORACLE",
    "RFF_ME_PAYOFF",
    "RFF_ME_RANGE",
    "RFF_ME_RESCUE",
    "RFF_ME_SADDC",
    "RFF_ME_SADFP",
    "RFF_ME_SADL",
    "RFF_ME_SADT",
    "RFF_ME_SADT_DBG",
    "RFF_ME_WIDE",
    "RFF_ME_WIDE_VAR",
    "RFF_MVCOST",
    "RFF_MVCOST_BIAS",
    "RFF_MVCOST_T",
    "RFF_MV_CMP",
    "RFF_MV_FORCE",
    "RFF_POLYTIER",
    "RFF_RDSKIP_MINFREE",
    "RFF_RDSKIP_T",
    "RFF_RD_CHROMA_W",
    "RFF_SATD_AVG",
    "RFF_SHAPE_RD",
    "RFF_SHAPE_RD_TEXMAX",
    "RFF_SIGNALS_CSV",
    "RFF_SPLIT_HARVEST",
    "RFF_SPLIT_MG",
    "RFF_SPLIT_T",
    "RFF_SP_FC",
    "RFF_SP_MAXIT",
    "RFF_SUB8X8",
    "RFF_SUB8X8_SPLIT",
    "RFF_SUB8_GRAIN",
    "RFF_SUB8_HARVEST",
    "RFF_SUB8_LEARN",
    "RFF_SUB8_MINPAY",
    "RFF_SUB8_RD",
    "RFF_SUB8_REGRET",
    "RFF_SUBPEL",
    "RFF_SUBPEL_DISPATCH",
    "RFF_SUBPEL_HARVEST",
    "RFF_SUBPEL_LEARN",
    "RFF_SUBPEL_PAT",
    "RFF_SUBPEL_SUB",
    "RFF_SUBPEL_T",
    "RFF_T8_SCREEN",
    "RFF_TQ_SCALAR",
    "RS_H264_ALLOC_SITE",
    "RS_H264_BATCH",
    "RS_H264_BS_PACKED",
    "RS_H264_BS_PRE",
    "RS_H264_BS_TWOPASS",
    "RS_H264_DEBLOCK_BRANCHY",
    "RS_H264_DEQUANT_AVX2",
    "RS_H264_DIRECT_MEMO",
    "RS_H264_DOUBLE_RECON",
    "RS_H264_EDC",
    "RS_H264_EDC_BOUND",
    "RS_H264_EDC_MT",
    "RS_H264_EDC_STATS",
    "RS_H264_FAT_SLICE",
    "RS_H264_FRAME_THREADS",
    "RS_H264_KIND_LOADS",
    "RS_H264_NORES",
    "RS_H264_NO_BSKIPFAST",
    "RS_H264_NO_MBKIND",
    "RS_H264_NO_POOL",
    "RS_H264_NO_RUNMV",
    "RS_H264_NO_SKIPBAND",
    "RS_H264_NO_SKIPFP",
    "RS_H264_PROF_SAMPLE",
    "RS_H264_QPEL_COMPOSE",
    "RS_H264_ROUTE_DUMP",
    "RS_H264_ROWDB",
    "RS_H264_ROWHOOK_EAGER",
    "RS_H264_ROW_PROGRESS",
    "RS_H264_ROW_PUB",
    "RS_H264_VERIFY_MBKIND",
    "RS_H264_VERIFY_PACKED",
    "RS_H264_VERIFY_UNIFORM_HINT",
    "RUSTY_FAST_INTRA",
    "RUSTY_H264_LEGACY_CAVLC",
    "RUSTY_THREADS",
];

/// Writes a movie with motion, noise and still parts.
fn write_movie(path: &Path) {
    let size = [96, 64];
    let mut random = Random::new(3);
    let frames = (0..30).map(|number| {
        let mut pixels = disc(size, number, false);
        for row in pixels.chunks_mut(size[0] as usize * 4).take(20) {
            row[..80].copy_from_slice(&noise([20, 1], &mut random));
        }
        pixels
    });
    write("mp4", &MovieSettings::new(size, rate("24")), MovieTarget::path(path), frames).unwrap();
}

#[test]
fn no_variable_of_the_environment_changes_the_bytes_of_a_movie() {
    if let Some(path) = std::env::var_os(MOVIE) {
        return write_movie(Path::new(&path));
    }
    let folder = Folder::new("movie-environment");
    let path = folder.join("it.mp4");
    write_movie(&path);
    let wanted = std::fs::read(&path).unwrap();
    let check = |names: &[&str], value: &str| {
        std::fs::remove_file(&path).unwrap();
        let output = Command::new(std::env::current_exe().unwrap())
            .args([TEST, "--exact", "--test-threads=1"])
            // Some of the variables are paths of files.
            .current_dir(folder.path())
            .env(MOVIE, &path)
            .envs(names.iter().map(|name| (name, value)))
            .output()
            .unwrap();
        assert!(output.status.success(), "{names:?} = {value}: {}", String::from_utf8_lossy(&output.stderr));
        assert!(std::fs::read(&path).unwrap() == wanted, "{names:?} = {value}: other bytes");
    };
    for value in ["0", "1", "3"] {
        check(VARIABLES, value);
        for name in VARIABLES.iter().filter(|_| takes_long()) {
            check(&[*name], value);
        }
    }
    let found = std::fs::read_dir(folder.path()).unwrap().map(|file| file.unwrap().path());
    assert_eq!(found.collect::<Vec<_>>(), [path]);
}
