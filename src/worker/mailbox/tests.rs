use super::*;
use crate::lab::Goal;
use crate::plan::RenderRequest;
use crate::scene::Scene;
use crate::worker::jobs::Pace;

fn live(revision: u64) -> Job {
    Job::Live(LiveJob {
        revision,
        scene: Arc::new(Scene::empty()),
        request: RenderRequest::sized(8, 8),
        pace: Pace::Whole,
    })
}

fn still(revision: u64, save_to: Option<&str>) -> Job {
    Job::Still(StillJob {
        revision,
        scene: Arc::new(Scene::empty()),
        request: RenderRequest::sized(8, 8),
        save_to: save_to.map(PathBuf::from),
    })
}

fn lab() -> Job {
    let scene = Arc::new(Scene::empty());
    Job::Lab(Box::new(Study::of_side(scene, 8)))
}

/// Takes the next job of a crew.
fn begin(mailbox: &mut Mailbox, crew: Crew) -> Option<Job> {
    mailbox.next(crew, &[]).map(|(job, _)| job)
}

fn control(mailbox: &Mailbox, crew: Crew) -> &RenderControl {
    &mailbox.running(crew).expect("running").control
}

#[test]
fn the_most_urgent_runs_first_and_the_newest_live_view_wins() {
    let mut mailbox = Mailbox::default();
    for job in [lab(), still(1, Some("a")), live(1), still(1, None), live(2)] {
        mailbox.put(job);
    }
    assert!(begin(&mut mailbox, Crew::Patient).is_none());
    let Some(Job::Live(live)) = begin(&mut mailbox, Crew::Prompt) else {
        panic!("what the window shows is first");
    };
    assert_eq!(live.revision, 2);
    assert!(begin(&mut mailbox, Crew::Patient).is_none());
    mailbox.finish(Crew::Prompt, None);
    assert!(begin(&mut mailbox, Crew::Prompt).is_none());
    let mut kinds = Vec::new();
    while let Some(job) = begin(&mut mailbox, Crew::Patient) {
        kinds.push(job.kind());
        mailbox.finish(Crew::Patient, None);
    }
    // The live view of a newer revision has made the still picture to look at pointless.
    assert_eq!(kinds, [JobKind::Save, JobKind::Lab]);
}

#[test]
fn what_is_written_waits_for_the_window_and_goes_on() {
    let mut mailbox = Mailbox::default();
    mailbox.put(still(1, Some("a")));
    begin(&mut mailbox, Crew::Patient).expect("a picture");
    for other in [lab(), still(1, None), still(1, Some("b"))] {
        mailbox.put(other);
        assert!(!mailbox.is_paused(), "all of these wait");
    }
    mailbox.put(live(2));
    begin(&mut mailbox, Crew::Prompt).expect("a live view");
    assert!(mailbox.is_paused());
    assert!(!control(&mailbox, Crew::Patient).is_stopped());
    mailbox.finish(Crew::Prompt, None);
    assert!(mailbox.is_paused(), "until it is said to go on");
    mailbox.put(live(3));
    mailbox.resume();
    assert!(mailbox.is_paused(), "not while somebody waits");
    begin(&mut mailbox, Crew::Prompt).expect("a live view");
    mailbox.finish(Crew::Prompt, None);
    mailbox.resume();
    assert!(!mailbox.is_paused());
    mailbox.finish(Crew::Patient, None);
    let next = begin(&mut mailbox, Crew::Patient).expect("a job");
    assert_eq!(next.kind(), JobKind::Save);
}

#[test]
fn what_measures_time_is_stopped_and_begins_anew() {
    let mut mailbox = Mailbox::default();
    for urgent in [live(1), still(1, None), still(1, Some("a"))] {
        mailbox.put(lab());
        let study = begin(&mut mailbox, Crew::Patient).expect("a study");
        let kind = urgent.kind();
        mailbox.put(urgent);
        assert!(control(&mailbox, Crew::Patient).is_stopped());
        mailbox.finish(Crew::Patient, Some(study));
        let first = begin(&mut mailbox, kind.crew()).expect("what is urgent");
        assert_eq!(first.kind(), kind);
        mailbox.finish(kind.crew(), None);
        let study = begin(&mut mailbox, Crew::Patient).expect("the study again");
        assert_eq!(study.kind(), JobKind::Lab);
        mailbox.finish(Crew::Patient, None);
    }
}

#[test]
fn what_is_replaced_does_not_come_back() {
    let mut mailbox = Mailbox::default();
    mailbox.put(still(1, None));
    let picture = begin(&mut mailbox, Crew::Patient).expect("a picture");
    mailbox.put(live(2));
    assert!(control(&mailbox, Crew::Patient).is_stopped());
    mailbox.finish(Crew::Patient, Some(picture));
    begin(&mut mailbox, Crew::Prompt).expect("a live view");
    mailbox.finish(Crew::Prompt, None);
    assert!(begin(&mut mailbox, Crew::Patient).is_none());
}

#[test]
fn what_is_paused_can_be_given_up() {
    let mut mailbox = Mailbox::default();
    mailbox.put(still(1, Some("a")));
    let picture = begin(&mut mailbox, Crew::Patient).expect("a picture");
    mailbox.put(live(2));
    assert!(mailbox.is_paused());
    mailbox.give_up(JobKind::Save);
    assert!(!mailbox.is_paused() && control(&mailbox, Crew::Patient).is_stopped());
    mailbox.finish(Crew::Patient, Some(picture));
    assert!(!mailbox.has(JobKind::Save));
}

#[test]
fn a_quality_that_is_asked_for_takes_the_place_of_the_one_before() {
    let quality = |error| {
        Job::Query(QueryJob {
            scene: Arc::new(Scene::empty()),
            question: Question::Quality(Goal::Within(error)),
        })
    };
    let mut mailbox = Mailbox::default();
    mailbox.put(quality(0.1));
    let job = begin(&mut mailbox, Crew::Prompt).expect("a job");
    mailbox.put(quality(0.2));
    assert!(control(&mailbox, Crew::Prompt).is_stopped());
    mailbox.finish(Crew::Prompt, Some(job));
    let job = begin(&mut mailbox, Crew::Prompt).expect("a job");
    assert!(matches!(
        job,
        Job::Query(QueryJob { question: Question::Quality(Goal::Within(error)), .. }) if error == 0.2
    ));
    mailbox.finish(Crew::Prompt, None);
    assert!(begin(&mut mailbox, Crew::Prompt).is_none());
}

#[test]
fn a_question_that_runs_is_dropped_for_a_newer_one_of_its_sort() {
    let ask = |number| {
        Job::Query(QueryJob {
            scene: Arc::new(Scene::empty()),
            question: Question::Visible(number, Box::default(), Vec::new()),
        })
    };
    let mut mailbox = Mailbox::default();
    mailbox.put(ask(1));
    let old = begin(&mut mailbox, Crew::Prompt).expect("a question");
    // The view moves on, and the next question comes before the old one has ended.
    mailbox.put(live(2));
    mailbox.put(ask(2));
    mailbox.finish(Crew::Prompt, Some(old));
    assert!(matches!(
        begin(&mut mailbox, Crew::Prompt),
        Some(Job::Live(_))
    ));
    mailbox.finish(Crew::Prompt, None);
    let next = begin(&mut mailbox, Crew::Prompt);
    let Some(Job::Query(query)) = next else {
        panic!("a question");
    };
    assert!(matches!(query.question, Question::Visible(2, ..)));
    mailbox.finish(Crew::Prompt, None);
    assert!(begin(&mut mailbox, Crew::Prompt).is_none());
}

#[test]
fn small_pictures_are_not_stopped() {
    let mut mailbox = Mailbox::default();
    mailbox.put(Job::Thumbnail(ThumbnailJob {
        name: 1,
        scene: Arc::new(Scene::empty()),
        size: (8, 8),
    }));
    begin(&mut mailbox, Crew::Prompt).expect("a job");
    mailbox.put(live(1));
    assert!(!control(&mailbox, Crew::Prompt).is_stopped());
}

#[test]
fn smooth_edges_wait_for_questions_and_end_with_the_next_view() {
    let smooth = |job: Option<Job>| match job {
        Some(Job::Live(live) | Job::Smooth(live)) => Some(Job::Smooth(live)),
        _ => panic!("a live view"),
    };
    let mut mailbox = Mailbox::default();
    mailbox.put(live(1));
    let traced = smooth(begin(&mut mailbox, Crew::Prompt));
    mailbox.finish(Crew::Prompt, traced);
    let running = begin(&mut mailbox, Crew::Prompt);
    assert!(matches!(running, Some(Job::Smooth(_))));
    mailbox.put(Job::Query(QueryJob {
        scene: Arc::new(Scene::empty()),
        question: Question::Visible(1, Box::default(), Vec::new()),
    }));
    assert!(control(&mailbox, Crew::Prompt).is_stopped());
    mailbox.finish(Crew::Prompt, smooth(running));
    let next = begin(&mut mailbox, Crew::Prompt);
    assert!(matches!(next, Some(Job::Query(_))));
    mailbox.finish(Crew::Prompt, None);
    let running = begin(&mut mailbox, Crew::Prompt);
    assert!(matches!(running, Some(Job::Smooth(_))));
    mailbox.put(live(2));
    mailbox.finish(Crew::Prompt, smooth(running));
    let next = begin(&mut mailbox, Crew::Prompt);
    assert!(matches!(next, Some(Job::Live(LiveJob { revision: 2, .. }))));
    mailbox.finish(Crew::Prompt, None);
    assert!(begin(&mut mailbox, Crew::Prompt).is_none());
}
